#include "launch/commands/env_tasks.h"

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "actor/worlds/tools/task_description.h"
#include "actor/worlds/tools/task_table.h"
#include "common/base/files.h"

namespace shoal::launch {
namespace {

int List(const std::string& json) {
  if (!json.empty()) WriteFileAtomically(json, worlds::TaskTableJson().dump(2) + "\n");
  std::cout << worlds::TaskTable() << std::flush;
  return 0;
}

int Describe(const worlds::DescribeRequest& request, const std::string& json) {
  if (!json.empty()) CheckWritable(json);
  const worlds::TaskDescription description = worlds::DescribeTask(request);
  if (!json.empty()) WriteFileAtomically(json, worlds::ToJson(description).dump(2) + "\n");
  std::cout << worlds::ToText(description) << std::flush;
  return 0;
}

void AddList(CLI::App& env, Action* chosen) {
  CLI::App* command = env.add_subcommand("list", "Every task there is, one line each.");
  const auto json = std::make_shared<std::string>();
  command->add_option("--json", *json, "File for the same (schema shoal-env-list-1)");
  command->callback([=] { *chosen = [=] { return List(*json); }; });
}

void AddDescribe(CLI::App& env, Action* chosen) {
  CLI::App* command = env.add_subcommand(
      "describe",
      "A task's observations (shape, unit, meaning, bounds, measured range), what each action axis "
      "does when moved alone, its reward and cameras.");
  const auto request = std::make_shared<worlds::DescribeRequest>();
  const auto json = std::make_shared<std::string>();
  command->add_option("task", request->task, "Task, e.g. FetchReachDense")->required();
  command->add_option("--json", *json, "File for the same (schema shoal-env-1)");
  command->add_option("--probe-steps", request->probe_env_steps, "Env steps of one command")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--random-steps", request->random_env_steps, "Env steps to measure ranges in")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command->add_option("--seed", request->seed, "Of the episodes and the random actions")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--model", request->model, "Another MJCF file for the task");
  command->callback([=] { *chosen = [=] { return Describe(*request, *json); }; });
}

}  // namespace

void AddEnvTaskCommands(CLI::App& env, Action* chosen) {
  AddList(env, chosen);
  AddDescribe(env, chosen);
}

}  // namespace shoal::launch
