// SPDX-License-Identifier: Apache-2.0
// Checks the promises that are visible in the reports of a run (metrics.jsonl): the limiter stays
// within its band, env steps never decrease, and the learner drops no usable rollout.
#pragma once

#include <string>
#include <vector>

#include "tests/simulation/oracles.h"

namespace shoal::simulation {

// Returns one line for each promise that is broken according to the reports. Throws Error.
std::vector<std::string> BrokenInReports(const World& world, const Facts& facts);

}  // namespace shoal::simulation
