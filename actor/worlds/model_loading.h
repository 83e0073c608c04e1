// SPDX-License-Identifier: Apache-2.0
// Models: from our embedded files or from a user's, and what identifies one.
#pragma once

#include <string>

#include "actor/worlds/engine_handles.h"

namespace shoal::worlds {

// A copy of the embedded file `name` ("fetch_reach.xml"), compiled once per process, or, when
// `user_file` is not empty, the file at that path, compiled now (its includes and meshes are looked
// up beside it). `addition`: MJCF elements ("<equality>...</equality>") that the model gets after
// its own. Equal text gives equal models, procedural textures included. Any thread, one at a time
// for files of users. Throws Error with the engine's reason when it does not load.
ModelHandle LoadModel(const std::string& name, const std::string& user_file,
                      const std::string& addition = "");

// State of a model, with all of its buffers.
DataHandle MakeData(const mjModel_& model);

// Hex hash of the compiled model's numbers and the engine's version. Equal for equal models
// whatever file they came from; to be taken before the model is changed.
std::string ModelFingerprint(const mjModel_& model);

}  // namespace shoal::worlds
