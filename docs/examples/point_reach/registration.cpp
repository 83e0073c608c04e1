// The one registration: both halves under one name.
#include "actor/worlds/own_tasks.h"
#include "actor/worlds/world_registry.h"
#include "point_reach.h"

namespace shoal::worlds {

void RegisterOwnTasks() { RegisterTask(point_reach::GoalHalf(), point_reach::MakePhysicsHalf); }

}  // namespace shoal::worlds
