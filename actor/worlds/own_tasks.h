// Tasks that are not part of Shoal: those of the folder given to CMake as SHOAL_OWN_TASKS.
#pragma once

namespace shoal::worlds {

// Calls RegisterTask (world_registry.h) for each of them. Defined in that folder; without one, in
// no_own_tasks.cpp. Every program that makes or names tasks calls it once, first.
void RegisterOwnTasks();

}  // namespace shoal::worlds
