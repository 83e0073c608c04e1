// SPDX-License-Identifier: Apache-2.0
// Which fresh episodes `shoal eval` plays when no seed is named.
#pragma once

#include <cstdint>
#include <filesystem>

namespace shoal::launch {

// Kept for the last word on a recipe: nothing is chosen by its episodes. One stream a task, since
// the episodes of a seed are the task's. docs/experiments.md ("Which episodes an evaluation
// plays").
constexpr int64_t kReservedEvaluationSeed = 20'261'126;

// A seed of the run's own, from its config.json: another run, seed or recipe plays other episodes,
// the same run always the same ones. Seeds begin at 10^9, above those that users choose. Throws
// Error: no config.json.
int64_t OwnEvaluationSeed(const std::filesystem::path& run);

}  // namespace shoal::launch
