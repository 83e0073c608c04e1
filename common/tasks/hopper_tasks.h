// SPDX-License-Identifier: Apache-2.0
// Goal halves of the Hopper tasks.
#pragma once

#include <vector>

#include "common/tasks/task.h"

namespace shoal::tasks {

// Hopper-v4 and Hopper-v5 (1000 control steps; v5 pays for being upright only while upright), and
// the pair CustomHopper-source and CustomHopper-target for sim-to-sim transfer (500 control steps;
// the source's torso is one kilogram lighter). No goals.
std::vector<Task> HopperTasks();

}  // namespace shoal::tasks
