#include "actor/worlds/own_tasks.h"

namespace shoal::worlds {

void RegisterOwnTasks() {}

}  // namespace shoal::worlds
