// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/task_table.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "common/tasks/task_registry.h"

namespace shoal::worlds {

using nlohmann::ordered_json;
using tasks::Task;

const char* RewardName(const Task& task) {
  if (task.goal_size() == 0) return "physics";
  return task.reward_kind() == tasks::RewardKind::kDense ? "dense" : "sparse";
}

std::string TaskTable() {
  std::string text = fmt::format("{:<24} {:<18} {:>6} {:>11} {:>4} {:>7}  {}\n", "task", "physics",
                                 "action", "observation", "goal", "length", "reward");
  for (const std::string& name : tasks::TaskNames()) {
    const Task& task = tasks::FindTask(name);
    text += fmt::format("{:<24} {:<18} {:>6} {:>11} {:>4} {:>7}  {}\n", name, task.world(),
                        task.action_size(), task.observation().size(), task.goal_size(),
                        task.EnvStepsPerEpisode(task.action_repeat()), RewardName(task));
  }
  return text;
}

ordered_json TaskTableJson() {
  ordered_json rows = ordered_json::array();
  for (const std::string& name : tasks::TaskNames()) {
    const Task& task = tasks::FindTask(name);
    rows.push_back({{"task", name},
                    {"world", task.world()},
                    {"action_size", task.action_size()},
                    {"observation_size", task.observation().size()},
                    {"goal_size", task.goal_size()},
                    {"episode_length", task.EnvStepsPerEpisode(task.action_repeat())},
                    {"reward", RewardName(task)}});
  }
  return {{"schema", "shoal-env-list-1"}, {"tasks", rows}};
}

}  // namespace shoal::worlds
