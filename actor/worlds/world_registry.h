// Physics halves by name.
#pragma once

#include <memory>
#include <string>

#include "actor/worlds/world.h"
#include "actor/worlds/world_options.h"

namespace shoal::worlds {

// `name` is Task::world() of a goal half; a goal half without physics is a bug (CHECK).
// Throws Error when a model does not load or lacks an element, or the world has no such physics.
std::unique_ptr<World> MakeWorld(const std::string& name, const WorldOptions& options);

// The camera of that name; throws Error (kUsage) listing those there are.
const CameraView& FindCamera(const World& world, const std::string& name);

}  // namespace shoal::worlds
