// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/played_episode.h"

#include <sys/resource.h>

#include <exception>
#include <utility>

#include "common/base/error.h"
#include "common/base/stop.h"
#include "common/checkpoint/checkpoint_files.h"
#include "launch/record/run_folder.h"
#include "launch/tools/film/film.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostKept = 4;  // runs
constexpr int kNice = 10;        // lower priority than the run's own processes

}  // namespace

PlayedEpisodes::~PlayedEpisodes() {
  ending_ = true;
  std::thread last;
  {
    const MutexLock lock(mutex_);
    last = std::move(thread_);
  }
  if (last.joinable()) last.join();
}

void PlayedEpisodes::Play(const fs::path& run) {
  const fs::path checkpoint = NewestCheckpoint(run);
  if (checkpoint.empty()) {
    throw RuntimeError("run '{}' has no checkpoint yet", run.filename().string());
  }
  const CheckpointState state = ReadCheckpointFiles(checkpoint).state;
  const MutexLock lock(mutex_);
  if (playing_) throw RuntimeError("an episode is being played: ask again when it is ready");
  if (thread_.joinable()) thread_.join();  // its work is done
  PlayedEpisode episode{.state = PlayedEpisode::State::kPlaying,
                        .checkpoint = checkpoint.filename().string(),
                        .env_steps = state.env_steps,
                        .updates = state.updates,
                        .seed = ++played_};
  // The previous film stays visible until the new one is ready.
  if (const auto it = episodes_.find(run); it != episodes_.end()) episode.film = it->second.film;
  while (episodes_.size() >= kMostKept && !episodes_.contains(run)) {
    std::error_code error;
    fs::remove(episodes_.begin()->second.film, error);
    episodes_.erase(episodes_.begin());
  }
  episodes_[run] = episode;
  playing_ = true;
  thread_ = std::thread([this, run, episode, checkpoint] { PlayOn(run, episode, checkpoint); });
}

void PlayedEpisodes::PlayOn(const fs::path& run, PlayedEpisode episode,
                            const fs::path& checkpoint) {
  // Sets the priority of this thread, which the program that it starts inherits.
  setpriority(PRIO_PROCESS, 0, kNice);
  const fs::path before =
      std::exchange(episode.film, scratch_.path() / fmt::format("{}.mp4", episode.seed));
  try {
    const auto film = MakeFilm(
        {.run = run,
         .checkpoints = {checkpoint},
         .episodes = 1,
         .seed = episode.seed,
         .output = episode.film},
        [this] { return ending_ || StopRequested(); }, [](const std::string&) {});
    episode.state = film ? PlayedEpisode::State::kReady : PlayedEpisode::State::kNone;
  } catch (const std::exception& e) {  // any exception would end the program, also one of a library
    episode.state = PlayedEpisode::State::kFailed;
    episode.problem = e.what();
  }
  if (episode.state == PlayedEpisode::State::kReady) {
    std::error_code error;
    fs::remove(before, error);
  } else {
    episode.film = before;
  }
  Keep(run, episode);
}

void PlayedEpisodes::Keep(const fs::path& run, const PlayedEpisode& episode) {
  const MutexLock lock(mutex_);
  episodes_[run] = episode;
  playing_ = false;
}

PlayedEpisode PlayedEpisodes::Of(const fs::path& run) const {
  const MutexLock lock(mutex_);
  const auto it = episodes_.find(run);
  return it == episodes_.end() ? PlayedEpisode() : it->second;
}

}  // namespace shoal::launch
