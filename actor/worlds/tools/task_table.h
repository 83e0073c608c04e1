// SPDX-License-Identifier: Apache-2.0
// Table of the registered tasks. Reads only the goal halves; no physics is loaded.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "common/tasks/task.h"

namespace shoal::worlds {

// Kind of reward: "dense" or "sparse" for tasks with goals, otherwise "physics".
const char* RewardName(const tasks::Task& task);

// One line per task: name, physics half, sizes, episode length, reward.
std::string TaskTable();
// The table as JSON, schema shoal-env-list-1.
nlohmann::ordered_json TaskTableJson();

}  // namespace shoal::worlds
