// SPDX-License-Identifier: Apache-2.0
// Success and return of the actors' episodes while a run trains, read from its metrics.jsonl.
//
// The actors explore, so these values are lower than the results of evaluations. The values are
// recorded every few seconds, so they show a learning curve even if a short run has only two or
// three evaluations.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace shoal::launch {

// Means over the actors' latest episodes (100 of each actor) at one moment of the run.
struct RolloutPoint {
  double env_steps = 0;
  double updates = 0;
  double wall_seconds = 0;                 // since the run's start
  std::optional<double> success{};         // rate, 0..1; empty if the task has no success
  std::optional<double> episode_return{};  // mean, unscaled; empty in files of older builds
};

// Reads the points in the order of the file. Every second point is left out, repeatedly, until at
// most `most` points are left. Empty if the file is missing, as in a committed copy of a run. Skips
// lines that are not JSON objects, because a killed coordinator may have left a partial line.
std::vector<RolloutPoint> ReadRolloutCurve(const std::filesystem::path& run, size_t most = 400);

}  // namespace shoal::launch
