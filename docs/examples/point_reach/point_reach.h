// PointReach: push a point over a plane to a goal. The example of docs/own_task.md.
#pragma once

#include <memory>

#include "actor/worlds/world.h"
#include "actor/worlds/world_options.h"
#include "common/tasks/task.h"

namespace point_reach {

// goal.cpp
shoal::tasks::Task GoalHalf();
// physics.cpp
std::unique_ptr<shoal::worlds::World> MakePhysicsHalf(const shoal::worlds::WorldOptions& options);

}  // namespace point_reach
