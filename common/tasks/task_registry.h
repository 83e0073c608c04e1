// SPDX-License-Identifier: Apache-2.0
// Tasks by name. A new task registers its goal half in task_registry.cpp and its physics half in
// actor/worlds/world_registry.cpp.
#pragma once

#include <string>
#include <vector>

#include "common/tasks/task.h"

namespace shoal::tasks {

// The task with this name. The reference is valid as long as the process runs. If there is no such
// task, throws Error (kUsage) that lists the known tasks.
const Task& FindTask(const std::string& name);

// The same task with this distance_threshold (m); 0 keeps the task's own threshold. Throws the same
// error, and Error (kUsage) if a threshold is given but the task has no goals.
Task FindTask(const std::string& name, double distance_threshold);

// The names of all tasks, in the order of registration.
std::vector<std::string> TaskNames();

// Adds a task. References to other tasks stay valid. Call this function at the start of a program,
// before other threads exist. Throws Error (kUsage) if the name is taken, or if the task has no
// action or no physics half.
void AddTask(Task task);

}  // namespace shoal::tasks
