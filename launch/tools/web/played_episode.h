// SPDX-License-Identifier: Apache-2.0
// An episode that a run's newest checkpoint plays for the page, as a film: the policy's input and a
// larger view, side by side. The evaluation's program plays the episode on request, at a lower
// priority than the run. The film is kept in a scratch folder, not in the run's folder.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <thread>

#include "common/base/mutex.h"
#include "launch/processes/scratch_folder.h"

namespace shoal::launch {

struct PlayedEpisode {
  enum class State { kNone, kPlaying, kReady, kFailed };
  State state = State::kNone;
  std::string checkpoint{};             // name of the checkpoint
  uint64_t env_steps = 0, updates = 0;  // of the checkpoint
  int64_t seed = 0;                     // of the episode
  std::string problem{};                // kFailed: one line
  std::filesystem::path film{};         // kReady
};

// Any thread. One episode is played at a time. For a few runs, the newest episode of the run is
// kept.
class PlayedEpisodes {
 public:
  PlayedEpisodes() = default;
  // Ends an episode that is being played.
  ~PlayedEpisodes();
  PlayedEpisodes(const PlayedEpisodes&) = delete;
  PlayedEpisodes& operator=(const PlayedEpisodes&) = delete;

  // Starts an episode and returns. Throws Error if another episode is being played, or if the run
  // has no checkpoint yet.
  void Play(const std::filesystem::path& run);
  PlayedEpisode Of(const std::filesystem::path& run) const;

 private:
  void PlayOn(const std::filesystem::path& run, PlayedEpisode episode,
              const std::filesystem::path& checkpoint);
  void Keep(const std::filesystem::path& run, const PlayedEpisode& episode);

  const ScratchFolder scratch_;
  std::atomic<bool> ending_ = false;
  mutable Mutex mutex_;
  std::map<std::filesystem::path, PlayedEpisode> episodes_ SHOAL_GUARDED_BY(mutex_);
  bool playing_ SHOAL_GUARDED_BY(mutex_) = false;
  int64_t played_ SHOAL_GUARDED_BY(mutex_) = 0;
  std::thread thread_ SHOAL_GUARDED_BY(mutex_);
};

}  // namespace shoal::launch
