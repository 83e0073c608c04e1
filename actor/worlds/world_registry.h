// SPDX-License-Identifier: Apache-2.0
// Registry of physics halves by name.
#pragma once

#include <memory>
#include <string>

#include "actor/worlds/world.h"
#include "actor/worlds/world_options.h"

namespace shoal::worlds {

// Makes a physics half and sets WorldOptions::task_folder. `name`: Task::world() of a goal half.
// Throws Error if there is no such world (kUsage), if the model does not load or lacks an element,
// or if the world does not support the physics.
std::unique_ptr<World> MakeWorld(const std::string& name, const WorldOptions& options);

using WorldMaker = std::unique_ptr<World> (*)(const WorldOptions& options);

// Registers a physics half; several tasks may share it. Call it at the start of a program, before
// threads start. Throws Error (kUsage) if the name is already registered. MakeWorld checks the
// result of `physics_half`: a null world and invalid cameras are errors (kUsage).
void AddWorld(const std::string& name, WorldMaker physics_half);

}  // namespace shoal::worlds
