// SPDX-License-Identifier: Apache-2.0
// Loading of a task's own model, from MJCF text in the program or from a file in the folder of a
// task library.
#pragma once

#include <string>

#include "actor/worlds/engine_handles.h"
#include "actor/worlds/world_options.h"

namespace shoal::worlds {

// Compiles the file at `user_file`, or `mjcf` if `user_file` is empty. Throws Error with the
// engine's reason if the model does not load.
ModelHandle LoadModelText(const std::string& mjcf, const std::string& user_file);

// Compiles the user's model file; if there is none, `file` in the folder of the task library:
// LoadModelFile(options, "model/arm.xml"). Includes, meshes and textures are looked up in the
// folder of the model file. Pass options.ModelOr(file) as World's second argument, so that messages
// name the file. Throws Error if the file does not exist, and the errors of LoadModelText.
ModelHandle LoadModelFile(const WorldOptions& options, const std::string& file);

}  // namespace shoal::worlds
