// SPDX-License-Identifier: Apache-2.0
// Tasks of one's own with both halves: common/tasks/task_library.h.
#pragma once

#include <string>

namespace shoal::worlds {

// For NAME.so loads the goal halves and, from NAME_physics.so beside it, the physics halves; an
// empty path is none. Rules and errors as for LoadTaskLibrary.
void LoadTasks(const std::string& task_library);

}  // namespace shoal::worlds
