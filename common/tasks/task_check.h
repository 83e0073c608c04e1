// SPDX-License-Identifier: Apache-2.0
// Checks a task's description for mistakes that would otherwise cause errors elsewhere.
#pragma once

#include "common/tasks/task.h"

namespace shoal::tasks {

inline constexpr int kMostNumbers = 65'536;  // limit for a state vector, and for a goal
inline constexpr int kMostActions = 1'024;   // limit for the components of an action

// Throws Error (kUsage), in one line that names the task and the block, for
//   - names that are empty, used twice or not valid,
//   - blocks without numbers or with too many numbers,
//   - bounds that are NaN or in the wrong order,
//   - an achieved goal and a desired goal of different size,
//   - an invalid length, action repeat or threshold.
//
// A block's name has at most 64 characters: letters, digits, underscores and dots. It begins with a
// letter or an underscore and does not end with a dot. The reason: the name is used as the name of
// an array in exports, as a key in files and as a part of "BLOCK-BLOCK" in sac.aux.
void CheckDescription(const Task::Description& description);

// Checks that a task can be trained: the task must have an action and a physics half. Throws Error
// (kUsage) that names the task.
void CheckPlayable(const Task& task);

}  // namespace shoal::tasks
