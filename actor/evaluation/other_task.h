// SPDX-License-Identifier: Apache-2.0
// Evaluation of a policy on another task than the training task, for example for sim-to-sim
// transfer.
#pragma once

#include <string>

#include "common/config/run_config.h"

namespace shoal::actor {

// Returns the run's configuration with `task` in place of the run's task. The run's randomization
// and model file are not applied to the new task. The returned spec is that of the new task. If the
// sizes of the new task's observations or actions do not fit the run's policy, throws Error naming
// both sizes.
RunConfig WithTask(const RunConfig& run, const std::string& task);

}  // namespace shoal::actor
