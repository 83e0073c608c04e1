// SPDX-License-Identifier: Apache-2.0
// Physics halves by name.
#pragma once

#include <memory>
#include <string>

#include "actor/worlds/world.h"
#include "actor/worlds/world_options.h"

namespace shoal::worlds {

// `name` is Task::world() of a goal half. Throws Error when there is no such world (kUsage), a
// model does not load or lacks an element, or the world has no such physics. Sets
// WorldOptions::task_folder.
std::unique_ptr<World> MakeWorld(const std::string& name, const WorldOptions& options);

using WorldMaker = std::unique_ptr<World> (*)(const WorldOptions& options);

// Adds a physics half; tasks may share one. At the start of a program, before threads. Throws Error
// (kUsage) when there is another of that name. What `physics_half` returns is checked when it is
// made: no world, or cameras that cannot be, are errors (kUsage).
void AddWorld(const std::string& name, WorldMaker physics_half);

}  // namespace shoal::worlds
