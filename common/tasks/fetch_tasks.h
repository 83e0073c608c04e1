// SPDX-License-Identifier: Apache-2.0
// Goal halves (task.h) of the Fetch tasks.
#pragma once

#include <vector>

#include "common/tasks/task.h"

namespace shoal::tasks {

// FetchReach, FetchPush, FetchSlide, FetchPickAndPlace, and the same tasks with dense rewards
// (FetchReachDense, ...). The achieved goal is the position of the grip site in Reach and the
// position of the object in the other tasks. A goal is reached if the distance is below 5 cm. An
// episode has 50 env steps.
std::vector<Task> FetchTasks();

}  // namespace shoal::tasks
