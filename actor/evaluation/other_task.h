// SPDX-License-Identifier: Apache-2.0
// Evaluation of a policy on another task than the one it was trained on, for example sim-to-sim
// transfer.
#pragma once

#include <string>

#include "common/config/run_config.h"

namespace shoal::actor {

// The run's configuration with another task in place of its own. The run's randomization and model
// file are not applied to the new task. The spec is the new task's. Throws Error naming both sizes
// if the new task's observations or actions do not have the sizes of the run's policy.
RunConfig WithTask(const RunConfig& run, const std::string& task);

}  // namespace shoal::actor
