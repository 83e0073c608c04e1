// SPDX-License-Identifier: Apache-2.0
// Goal halves of the Fetch tasks.
#pragma once

#include <vector>

#include "common/tasks/task.h"

namespace shoal::tasks {

// FetchReach, FetchPush, FetchSlide and FetchPickAndPlace, each also as ...Dense. The achieved goal
// is the position of the grip site in Reach, of the object in the others; reached within 5 cm; 50
// env steps an episode.
std::vector<Task> FetchTasks();

}  // namespace shoal::tasks
