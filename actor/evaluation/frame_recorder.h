// SPDX-License-Identifier: Apache-2.0
// Records what the policy of one episode runner sees and does, and a larger view of it, into a
// stream of frames (common/image/frame_stream.h): for films.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "actor/acting/episode_runner.h"
#include "actor/evaluation/episode_view.h"
#include "common/image/frame_stream.h"
#include "common/spec/observation_spec.h"

namespace shoal::actor {

// Owns the view. One thread.
class FrameRecorder final : public EpisodeListener {
 public:
  struct Options {
    std::filesystem::path file;
    // Camera of the view; empty = the task's for films, else the run's first, else the task's
    // first.
    std::string camera = "";
    int height = 480, width = 480;  // of the view
    // fast | native | reference. Empty = native for runs in quality native, which then need no
    // OSMesa; else reference.
    std::string quality = "";
  };
  // `spec`: of what the policy observes. Throws Error on a file that cannot be written.
  FrameRecorder(const ObservationSpec& spec, const std::filesystem::path& file,
                std::unique_ptr<EpisodeView> view);

  void OnBegin(uint64_t stream_key, std::span<const uint8_t> stack) override;
  void OnStep(const SeenStep& step) override;
  // Shows the last picture once more, as the episode's end: films show as many episodes as were
  // played.
  void OnFault(std::span<const uint8_t> stack) override;

 private:
  const std::unique_ptr<EpisodeView> view_;
  std::vector<uint8_t> picture_;  // (H, W, 3): the view's
  image::FrameStreamWriter writer_;
  std::vector<float> no_action_;
  uint32_t episode_ = 0, step_ = 0;
  bool running_ = false;  // an episode has begun and has not ended
};

}  // namespace shoal::actor
