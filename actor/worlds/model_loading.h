// SPDX-License-Identifier: Apache-2.0
// Loading of models, from embedded files or from a user's file, and their fingerprints.
#pragma once

#include <string>

#include "actor/worlds/engine_handles.h"

namespace shoal::worlds {

// Loads a model. If `user_file` is not empty, compiles the file at that path; its includes and
// meshes are looked up in the same folder. Otherwise returns a copy of the embedded file `name`
// ("fetch_reach.xml"), which is compiled once per process. `addition`: MJCF elements
// ("<equality>...</equality>") that are appended to the model. Equal text gives equal models,
// including procedural textures. May be called on any thread; a user's file on one thread at a
// time. Throws Error with the engine's reason if the model does not load.
ModelHandle LoadModel(const std::string& name, const std::string& user_file,
                      const std::string& addition = "");

// Allocates the state of a model, with all of its buffers.
DataHandle MakeData(const mjModel_& model);

// Hex hash of the compiled model's numbers and the engine's version. Equal models have equal
// fingerprints, independent of their files. Call before the model is changed.
std::string ModelFingerprint(const mjModel_& model);

}  // namespace shoal::worlds
