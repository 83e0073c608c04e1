// SPDX-License-Identifier: Apache-2.0
// Checks a task's description for mistakes that would otherwise cause errors elsewhere.
#pragma once

#include "common/tasks/task.h"

namespace shoal::tasks {

inline constexpr int kMostNumbers = 65'536;  // of a state vector or a goal
inline constexpr int kMostActions = 1'024;   // components of an action

// Throws Error (kUsage), in one line that names the task and the block: names that are empty, taken
// twice or no identifiers; blocks without numbers or with too many; bounds that are NaN or in the
// wrong order; goals of different size; a length, an action repeat or a threshold that makes no
// sense.
//
// A block's name becomes an array of exports, a key of files and part of "BLOCK-BLOCK" in
// sac.aux: letters, digits, underscores and dots, beginning with a letter or an underscore, not
// ending with a dot, at most 64.
void CheckDescription(const Task::Description& description);

// Checks that a task can be trained: it has an action and a physics half. Errors as above.
void CheckPlayable(const Task& task);

}  // namespace shoal::tasks
