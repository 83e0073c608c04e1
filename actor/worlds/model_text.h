// SPDX-License-Identifier: Apache-2.0
// A model from MJCF text in the program, or from a file beside a task library: for tasks that bring
// their own.
#pragma once

#include <string>

#include "actor/worlds/engine_handles.h"
#include "actor/worlds/world_options.h"

namespace shoal::worlds {

// Compiles `mjcf`, or the file at `user_file` where that is not empty. Throws Error with the
// engine's reason when it does not load.
ModelHandle LoadModelText(const std::string& mjcf, const std::string& user_file);

// Compiles the user's model file, or, where there is none, `file` beside the task library:
// LoadModelFile(options, "model/arm.xml"). Its includes, meshes and textures are looked up beside
// it. World's second argument is then options.ModelOr(file), so that messages name the file. Errors
// as above, and a file that does not exist.
ModelHandle LoadModelFile(const WorldOptions& options, const std::string& file);

}  // namespace shoal::worlds
