// SPDX-License-Identifier: Apache-2.0
// Tasks by name. A new task registers its goal half in task_registry.cpp and its physics half in
// actor/worlds/world_registry.cpp.
#pragma once

#include <string>
#include <vector>

#include "common/tasks/task.h"

namespace shoal::tasks {

// The task with this name; valid as long as the process runs. Throws Error (kUsage) listing the
// known tasks.
const Task& FindTask(const std::string& name);

// The same task with this distance_threshold (m) in place of its own, unless that is 0. Throws
// Error (kUsage) also when the task has no goals.
Task FindTask(const std::string& name, double distance_threshold);

// The names of all tasks, in the order of registration.
std::vector<std::string> TaskNames();

// Adds a task; references to other tasks stay valid. Call at the start of a program, before
// threads. Throws Error (kUsage) when the name is taken, or when the task has no action or no
// physics half.
void AddTask(Task task);

}  // namespace shoal::tasks
