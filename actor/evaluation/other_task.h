// SPDX-License-Identifier: Apache-2.0
// A policy on a task that it was not trained for, as from one simulation to another.
#pragma once

#include <string>

#include "common/config/run_config.h"

namespace shoal::actor {

// The run's configuration with another task in place of its own: that task as it is, without the
// randomization and without the model file of the run. The spec is the new task's. Throws Error
// naming both sides when its observations or actions are not of the sizes that the run's policy
// takes.
RunConfig WithTask(const RunConfig& run, const std::string& task);

}  // namespace shoal::actor
