// SPDX-License-Identifier: Apache-2.0
// Loading of users' tasks with both halves: common/tasks/task_library.h.
#pragma once

#include <string>

namespace shoal::worlds {

// Loads the goal halves from NAME.so and the physics halves from NAME_physics.so in the same
// folder. `task_library`: path of NAME.so; empty = none. The rules and errors are those of
// LoadTaskLibrary.
void LoadTasks(const std::string& task_library);

}  // namespace shoal::worlds
