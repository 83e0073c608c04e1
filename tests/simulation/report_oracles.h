// SPDX-License-Identifier: Apache-2.0
// The promises of a run that its reports (metrics.jsonl) show: the limiter keeps to its band, env
// steps never become fewer, and the learner drops no rollout that it could use.
#pragma once

#include <string>
#include <vector>

#include "tests/simulation/oracles.h"

namespace shoal::simulation {

// Returns one line for each promise that the reports of the run do not keep. Throws Error.
std::vector<std::string> BrokenInReports(const World& world, const Facts& facts);

}  // namespace shoal::simulation
