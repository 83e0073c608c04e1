// SPDX-License-Identifier: Apache-2.0
#include "launch/commands/env_tasks.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "actor/evaluation/random_baseline.h"
#include "actor/worlds/tools/reward_check.h"
#include "actor/worlds/tools/task_description.h"
#include "actor/worlds/tools/task_table.h"
#include "common/base/error.h"
#include "common/base/stop.h"
#include "common/config/config_io.h"
#include "common/config/run_files.h"
#include "common/run_folder/run_file_names.h"
#include "common/tasks/task_registry.h"
#include "launch/commands/json_output.h"
#include "launch/processes/actor_program.h"
#include "launch/record/environment_mapping.h"
#include "launch/record/run_folder.h"
#include "launch/record/run_inputs.h"
#include "launch/run/run_request.h"
#include "launch/run/train_options.h"

namespace shoal::launch {
namespace {

// Writes the JSON if requested, then the text.
void Show(const JsonOutput& output, const nlohmann::ordered_json& json, const std::string& text) {
  output.Write(json.dump(2) + "\n");
  std::fputs(text.c_str(), output.text());
}

int List(const std::string& json) {
  Show(JsonOutput(json), worlds::TaskTableJson(), worlds::TaskTable());
  return 0;
}

int Describe(const worlds::DescribeRequest& request, const std::string& json) {
  const JsonOutput output(json);
  const worlds::TaskDescription description = worlds::DescribeTask(request);
  Show(output, worlds::ToJson(description), worlds::ToText(description));
  return 0;
}

// Selects the inputs to describe: those of a run, or those that runs of a preset or of a Python
// environment would have.
struct InputsRequest {
  std::string run, run_dir = "runs", preset, environment;
  std::vector<std::string> set;  // KEY=VALUE, for an environment
};

RunConfig ConfigOf(const InputsRequest& request) {
  if (!request.run.empty()) return ReadRunConfig(FindNamed(request.run, RunsIn(request.run_dir)));
  if (!request.environment.empty()) {
    TrainOptions options;
    options.preset = request.preset;
    options.set = request.set;
    options.set.push_back("env.id=" + request.environment);
    return ResolveFresh(options).config;
  }
  const Config config = LoadPreset(request.preset);
  return {config, DescribeObservations(config).spec};
}

int PrintInputs(const InputsRequest& request, const std::string& json) {
  const JsonOutput output(json);
  const RunConfig run = ConfigOf(request);
  if (run.spec.environment.empty()) {
    Show(output, InputsJson(run), DescribeInputs(run));
  } else {
    Show(output, MappingJson(run), DescribeMapping(run) + DescribeInputs(run));
  }
  return 0;
}

// Whether a word is the name of a user's environment: a module or a file and a name behind a
// colon, or a name with a version, such as "Pendulum-v1", that no task has.
bool NamesEnvironment(const std::string& word) {
  if (word.find(':') != std::string::npos) return true;
  const size_t version = word.rfind("-v");
  const auto names = tasks::TaskNames();
  return version != std::string::npos && version + 2 < word.size() &&
         word.find_first_not_of("0123456789", version + 2) == std::string::npos &&
         std::ranges::count(names, word) == 0;
}

int CheckRewards(const worlds::RewardCheckRequest& request, const std::string& json) {
  const JsonOutput output(json);
  const worlds::RewardCheck check = worlds::CheckRewards(request);
  Show(output, worlds::ToJson(check), worlds::ToText(check));
  return check.Passed() ? 0 : 1;
}

int PlayRandom(const actor::RandomRequest& request, const std::string& json) {
  const JsonOutput output(json);
  InstallStopSignals();
  const nlohmann::ordered_json result = actor::PlayRandom(request, StopRequested);
  Show(output, result, actor::RandomText(result));
  return 0;
}

// Options that several commands take.
void AddJson(CLI::App* command, const std::string& schema, std::string* json) {
  command->add_option(
      "--json", *json,
      "Write the result as JSON to this file, which is replaced; - for standard output (schema " +
          schema + ")");
}
void AddTask(CLI::App* command, std::string* task, std::string* model) {
  command->add_option("task", *task, "Task, e.g. FetchReachDense")->required();
  command->add_option("--model", *model, "Another MJCF file for the task");
}
void AddSeed(CLI::App* command, int64_t* seed) {
  command->add_option("--seed", *seed, "Seed of the episodes and the random actions")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
}

void AddList(CLI::App& env, Action* chosen) {
  CLI::App* command = env.add_subcommand("list", "List every task, one line each.");
  const auto json = std::make_shared<std::string>();
  AddJson(command, "shoal-env-list-1", json.get());
  command->callback([=] { *chosen = [=] { return List(*json); }; });
}

// Refuses options of a user's environment (`of_environments`) together with a task, and --model
// together with an environment.
void CheckOptionsOf(const std::string& name, bool hosted,
                    const std::vector<const CLI::Option*>& of_environments,
                    const CLI::Option* model) {
  const auto is_given = [](const CLI::Option* option) { return option->count() > 0; };
  if (!hosted && std::ranges::any_of(of_environments, is_given)) {
    throw UsageError(
        "env describe: --preset and --set go with an environment of yours, not with "
        "the task {}",
        name);
  }
  if (hosted && is_given(model)) {
    throw UsageError("env describe: --model goes with a task of Shoal's, not with environment {}",
                     name);
  }
}

void AddDescribe(CLI::App& env, Action* chosen) {
  CLI::App* command = env.add_subcommand(
      "describe",
      "Describe a task: its observations (shape, unit, meaning, bounds, measured range), the "
      "effect of each action axis alone, its reward and cameras. For an environment of yours: how "
      "its spaces become frames, blocks and actions. For a run: the inputs of its policy, and the "
      "privileged inputs of training.");
  const auto request = std::make_shared<worlds::DescribeRequest>();
  const auto inputs = std::make_shared<InputsRequest>();
  const auto json = std::make_shared<std::string>();
  // The task may be a user's environment; --preset can then name the preset of its runs.
  CLI::Option* task = command->add_option(
      "task", request->task,
      "Task, e.g. FetchReachDense, or environment of yours, e.g. Pendulum-v1 (as for env check)");
  CLI::Option* run =
      command->add_option("--run", inputs->run, "Run in place of a task: name or folder");
  run->excludes(task);
  command->add_option("--run-dir", inputs->run_dir, "Folder that holds the runs")
      ->capture_default_str();
  CLI::Option* preset = command->add_option("--preset", inputs->preset,
                                            "Preset instead of a task: describes the inputs of its "
                                            "runs; with an environment, the preset of its runs");
  preset->excludes(run);
  CLI::Option* set =
      command
          ->add_option("--set", inputs->set, "KEY=VALUE of an environment's runs; may be repeated")
          ->allow_extra_args(false)
          ->needs(task);
  CLI::Option* model =
      command->add_option("--model", request->model, "Another MJCF file for the task")->needs(task);
  AddJson(command,
          "shoal-env-1, of a run or a preset shoal-inputs-1, of an environment or its run "
          "shoal-env-mapping-1",
          json.get());
  command
      ->add_option("--probe-steps", request->probe_env_steps,
                   "Env steps for which one action axis is moved")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--random-steps", request->random_env_steps,
                   "Random env steps from which the ranges are measured")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  AddSeed(command, &request->seed);
  command->callback([=] {
    if (task->count() + run->count() + preset->count() == 0) {
      throw UsageError(
          "env describe: nothing is named; expected a task, --run RUN or --preset NAME");
    }
    const bool hosted = task->count() > 0 && NamesEnvironment(request->task);
    if (task->count() > 0) CheckOptionsOf(request->task, hosted, {preset, set}, model);
    if (hosted) inputs->environment = request->task;
    *chosen = [=] {
      return task->count() > 0 && !hosted ? Describe(*request, *json) : PrintInputs(*inputs, *json);
    };
  });
}

void AddRewardCheck(CLI::App& env, Action* chosen) {
  CLI::App* command =
      env.add_subcommand("reward-check",
                         "Compare every step's reward with the goal half and with the formula, "
                         "also for relabelled goals. Exit code 1 if a number differs.");
  const auto request = std::make_shared<worlds::RewardCheckRequest>();
  const auto json = std::make_shared<std::string>();
  AddTask(command, &request->task, &request->model);
  AddJson(command, "shoal-reward-check-1", json.get());
  command->add_option("--steps", request->env_steps, "Random env steps to check")
      ->check(CLI::Range(1, 100'000))
      ->capture_default_str();
  AddSeed(command, &request->seed);
  command->callback([=] { *chosen = [=] { return CheckRewards(*request, *json); }; });
}

void AddRandom(CLI::App& env, Action* chosen) {
  CLI::App* command = env.add_subcommand(
      "random",
      "Measure the score of uniform random or zero actions, and its dependence on the threshold.");
  const auto request = std::make_shared<actor::RandomRequest>();
  const auto json = std::make_shared<std::string>();
  AddTask(command, &request->task, &request->model);
  AddJson(command, kEvaluationSchema, json.get());
  command->add_option("--policy", request->policy, "random | noop (every action is zero)")
      ->capture_default_str();
  command->add_option("--episodes", request->episodes, "Episodes to play")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  AddSeed(command, &request->seed);
  command->callback([=] { *chosen = [=] { return PlayRandom(*request, *json); }; });
}

}  // namespace

void AddEnvTaskCommands(CLI::App& env, Action* chosen) {
  AddList(env, chosen);
  AddDescribe(env, chosen);
  AddRandom(env, chosen);
  AddRewardCheck(env, chosen);
}

}  // namespace shoal::launch
