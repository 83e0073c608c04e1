// SPDX-License-Identifier: Apache-2.0
// Tasks by name. A new task registers its goal half in task_registry.cpp and its physics half in
// actor/worlds/world_registry.cpp.
#pragma once

#include <string>
#include <vector>

#include "common/tasks/task.h"

namespace shoal::tasks {

// Lives as long as the process. Throws Error (kUsage) listing the tasks there are.
const Task& FindTask(const std::string& name);

// The same task with this distance_threshold (m) in place of its own, unless that is 0. Throws
// Error (kUsage) also when the task has no goals.
Task FindTask(const std::string& name, double distance_threshold);

// In the order of registration.
std::vector<std::string> TaskNames();

// Adds a task; tasks found before stay where they are. At the start of a program, before threads.
// Throws Error (kUsage) when there is one of that name, or when it has no action or no physics
// half.
void AddTask(Task task);

}  // namespace shoal::tasks
