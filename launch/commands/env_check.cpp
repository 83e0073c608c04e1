// SPDX-License-Identifier: Apache-2.0
// shoal env check: shows how Shoal maps a user's environment, and checks its declared spaces.
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/base/usable_cores.h"
#include "launch/commands/env_tasks.h"
#include "launch/commands/json_output.h"
#include "launch/processes/actor_program.h"
#include "launch/record/environment_mapping.h"
#include "launch/run/train_options.h"

namespace shoal::launch {
namespace {

std::string ArrayText(const tasks::ArraySpace& space) {
  const std::string shape = fmt::format("{}", fmt::join(space.shape, "x"));
  if (const auto image = ImageLayoutOf(space)) {
    return fmt::format("  {}: image {}, {} channel(s), frames of camera '{}'\n", space.name, shape,
                       image->channels, space.name);
  }
  return fmt::format("  {}: {} in {}, block of {} numbers\n", space.name, shape, BoundsText(space),
                     space.size());
}

std::string GoalText(const tasks::EnvironmentDescription& environment) {
  if (environment.goal) {
    // Dense rewards do not show success, which depends on the threshold.
    if (environment.goal->reward == tasks::RewardKind::kDense) {
      return "  OK    hindsight: the rewards are dense, minus the distance; verified\n";
    }
    return fmt::format("  OK    hindsight: the rewards are sparse, threshold {:g}; verified\n",
                       environment.goal->threshold);
  }
  if (environment.no_goal.empty()) return "";
  return fmt::format("  WARN  no hindsight: {}\n", environment.no_goal);
}

std::string RepeatText(const DescribedEnvironment& described) {
  if (!described.differs_at) {
    return fmt::format("  OK    equal seeds and actions gave equal episodes ({} steps)\n",
                       described.repeated_steps);
  }
  return fmt::format(
      "  WARN  equal seeds and actions gave other observations or rewards from step {} on: runs "
      "cannot repeat\n",
      *described.differs_at);
}

std::string Text(const DescribedEnvironment& described, const Config& config) {
  const tasks::EnvironmentDescription& environment = described.description;
  std::string text = fmt::format("{}, task {}, run by {}\n", environment.id, environment.task,
                                 config.env.python.empty() ? "shoal-actor" : config.env.python);
  for (const tasks::ArraySpace& space : environment.observation) text += ArrayText(space);
  text += fmt::format("  action: {} numbers in {}, mapped to [-1, 1]\n", environment.action.size(),
                      BoundsText(environment.action));
  text += environment.episode_steps > 0
              ? fmt::format("  episodes of at most {} steps", environment.episode_steps)
              : "  episodes without a time limit that Shoal knows";
  text += environment.success ? "; steps report success\n" : "; success is not reported\n";
  text += fmt::format("  OK    {} random steps, {:.0f} microseconds each\n", described.steps,
                      described.step_microseconds);
  return text + RepeatText(described) + GoalText(environment);
}

nlohmann::ordered_json Json(const DescribedEnvironment& described) {
  nlohmann::ordered_json json{{"schema", "shoal-env-check-1"},
                              {"environment", ToJson(described.description)},
                              {"steps", described.steps},
                              {"step_microseconds", described.step_microseconds},
                              {"repeats", !described.differs_at.has_value()}};
  if (described.differs_at) json["differs_at"] = *described.differs_at;
  return json;
}

int CheckEnvironment(const TrainOptions& options, const std::string& json) {
  const JsonOutput output(json);
  const Config config = ResolveConfig(options, UsableCores());
  const DescribedEnvironment described = DescribeEnvironment(config);
  output.Write(Json(described).dump(2) + "\n");
  std::fputs(Text(described, config).c_str(), output.text());
  return 0;
}

}  // namespace

void AddEnvCheckCommand(CLI::App& env, Action* chosen) {
  CLI::App* command = env.add_subcommand(
      "check",
      "Create an environment of yours, play it, and report how it is observed, whether it repeats, "
      "and whether hindsight is possible (docs/own_environment.md).");
  const auto environment = std::make_shared<std::string>();
  const auto options = std::make_shared<TrainOptions>();
  const auto json = std::make_shared<std::string>();
  command
      ->add_option("environment", *environment,
                   "A name that gymnasium.make knows, MODULE:NAME, FILE.py:NAME or FILE.so:NAME")
      ->required();
  command->add_option("--set", options->set, "KEY=VALUE, such as env.kwargs; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--json", *json,
                      "Write the result as JSON to this file, which is replaced; - for standard "
                      "output (schema shoal-env-check-1)");
  command->callback([=] {
    options->set.push_back("env.id=" + *environment);
    *chosen = [=] { return CheckEnvironment(*options, *json); };
  });
}

}  // namespace shoal::launch
