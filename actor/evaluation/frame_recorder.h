// SPDX-License-Identifier: Apache-2.0
// Recorder for films. Writes the observations and actions of one episode runner's policy, and a
// larger view of the scene, to a stream of frames (common/image/frame_stream.h).
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
    // Camera of the view. Empty = the task's camera for films; if the task has no such camera, the
    // run's first camera; if the run has no camera, the task's first camera.
    std::string camera = "";
    int height = 480, width = 480;  // of the view
    // fast | native | reference. Empty = native for runs in quality native, so that these runs need
    // no OSMesa; reference for other runs.
    std::string quality = "";
  };
  // `spec`: observation spec of the policy. Throws Error if the file cannot be written.
  FrameRecorder(const ObservationSpec& spec, const std::filesystem::path& file,
                std::unique_ptr<EpisodeView> view);

  void OnBegin(uint64_t stream_key, std::span<const uint8_t> stack) override;
  void OnStep(const SeenStep& step) override;
  // Writes the last picture once more and marks it as the episode's end. An episode that is faulty
  // from the start is therefore also in the film.
  void OnFault(std::span<const uint8_t> stack) override;

 private:
  const std::unique_ptr<EpisodeView> view_;
  std::vector<uint8_t> picture_;  // (H, W, 3), of the view
  image::FrameStreamWriter writer_;
  std::vector<float> no_action_;
  uint32_t episode_ = 0, step_ = 0;
  bool running_ = false;  // an episode has begun and has not ended
};

}  // namespace shoal::actor
