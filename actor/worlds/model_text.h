// SPDX-License-Identifier: Apache-2.0
// A model from MJCF text in the program: for tasks that bring their own.
#pragma once

#include <string>

#include "actor/worlds/engine_handles.h"

namespace shoal::worlds {

// Compiles `mjcf`, or the file at `user_file` where that is not empty. Throws Error with the
// engine's reason when it does not load.
ModelHandle LoadModelText(const std::string& mjcf, const std::string& user_file);

}  // namespace shoal::worlds
