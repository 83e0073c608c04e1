// SPDX-License-Identifier: Apache-2.0
// Success and return of the actors' episodes while a run trains, read from its metrics.jsonl.
//
// The actors explore, so these figures lie below those of evaluations. They are recorded every few
// seconds and therefore show a learning curve where a short run has two or three evaluations.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace shoal::launch {

// The actors' latest episodes (100 of each actor) at one moment of the run.
struct RolloutPoint {
  double env_steps = 0;
  double updates = 0;
  double wall_seconds = 0;                 // since the run's start
  std::optional<double> success{};         // rate, 0..1; empty where the task has none
  std::optional<double> episode_return{};  // mean, unscaled; empty in files of older builds
};

// The points in the order of the file, thinned to at most `most` by leaving out every second one.
// Empty without the file, as in a committed copy of a run. Lines that are not JSON objects are
// skipped: a killed coordinator may have left half of one.
std::vector<RolloutPoint> ReadRolloutCurve(const std::filesystem::path& run, size_t most = 400);

}  // namespace shoal::launch
