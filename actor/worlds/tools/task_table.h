// SPDX-License-Identifier: Apache-2.0
// The registered tasks at a glance. Reads the goal halves only: no physics is loaded.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/tasks/task.h"

namespace shoal::worlds {

// "dense" or "sparse" for tasks with goals, else "physics".
const char* RewardName(const tasks::Task& task);

// One line per task: name, physics half, sizes, episode length, reward.
std::string TaskTable();
// The same, schema shoal-env-list-1.
nlohmann::ordered_json TaskTableJson();

}  // namespace shoal::worlds
