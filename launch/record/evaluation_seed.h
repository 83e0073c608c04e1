// SPDX-License-Identifier: Apache-2.0
// Seeds of the fresh episodes of `shoal eval` when the user gives no seed.
#pragma once

#include <cstdint>
#include <filesystem>

namespace shoal::launch {

// Seed reserved for the final evaluation of a recipe: no choice may depend on its episodes. All
// runs of a task play the same episodes with the same seed. See docs/experiments.md ("Which
// episodes an evaluation plays").
constexpr int64_t kReservedEvaluationSeed = 20'261'126;

// A seed for this run, computed from its config.json. The same run always plays the same episodes;
// another run, seed or recipe plays other episodes. These seeds begin at 10^9, above the seeds that
// users choose. Throws Error if config.json does not exist.
int64_t OwnEvaluationSeed(const std::filesystem::path& run);

}  // namespace shoal::launch
