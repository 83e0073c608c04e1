// SPDX-License-Identifier: Apache-2.0
// Goal halves (task.h) of the Hopper tasks.
#pragma once

#include <vector>

#include "common/tasks/task.h"

namespace shoal::tasks {

// Hopper-v4 and Hopper-v5 have 1000 control steps; in v5, the reward for being upright is paid only
// while the hopper is upright. CustomHopper-source and CustomHopper-target, a pair for sim-to-sim
// transfer, have 500 control steps; the torso of the source is one kilogram lighter. The tasks have
// no goals.
std::vector<Task> HopperTasks();

}  // namespace shoal::tasks
