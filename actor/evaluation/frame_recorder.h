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
#include "common/config/run_config.h"
#include "common/image/frame_stream.h"

namespace shoal::actor {

// The view is drawn by an environment of its own, which plays the same episodes by the same
// actions: equal stream keys and actions give equal physics, so the runner's environment needs to
// know nothing of it. The view shows the goal's marker, whether or not the policy's pictures do.
// Owns that environment. One thread.
class FrameRecorder final : public EpisodeListener {
 public:
  struct Options {
    std::filesystem::path file;
    // Camera of the view; empty = the task's for films, else the run's first, else the task's
    // first.
    std::string camera = "";
    int height = 480, width = 480;      // of the view
    std::string quality = "reference";  // of the view: fast | native | reference
  };
  // Throws Error: a camera that the task does not have, a file that cannot be written.
  FrameRecorder(const RunConfig& run, const Options& options);

  void OnBegin(uint64_t stream_key, std::span<const uint8_t> stack) override;
  // CHECK that both environments earn the same.
  void OnStep(const SeenStep& step) override;
  // Shows the last picture once more, as the episode's end: films show as many episodes as were
  // played.
  void OnFault(std::span<const uint8_t> stack) override;

 private:
  void Write(const image::FrameRecordHeader& record, std::span<const float> action,
             std::span<const uint8_t> stack);

  std::unique_ptr<worlds::Environment> view_;
  std::vector<uint8_t> planes_, interleaved_;  // the view as it is drawn: (3, H, W); as written
  std::vector<float> vector_;
  image::FrameStreamWriter writer_;
  std::vector<float> no_action_;
  uint32_t episode_ = 0, step_ = 0;
  bool running_ = false;  // an episode has begun and has not ended
};

}  // namespace shoal::actor
