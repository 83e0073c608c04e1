// Physics halves by name.
#pragma once

#include <memory>
#include <string>

#include "actor/worlds/world.h"
#include "actor/worlds/world_options.h"
#include "common/tasks/task.h"

namespace shoal::worlds {

// `name` is Task::world() of a goal half; a goal half without physics is a bug (CHECK).
// Throws Error when a model does not load or lacks an element, or the world has no such physics.
std::unique_ptr<World> MakeWorld(const std::string& name, const WorldOptions& options);

using WorldMaker = std::unique_ptr<World> (*)(const WorldOptions& options);

// Adds a task with both halves; tasks may share a physics half. At the start of a program, before
// threads. Throws Error (kUsage) when there is a task of that name, or another physics half of
// goal_half.world()'s name.
void RegisterTask(tasks::Task goal_half, WorldMaker physics_half);

// The camera of that name; throws Error (kUsage) listing those there are.
const CameraView& FindCamera(const World& world, const std::string& name);

}  // namespace shoal::worlds
