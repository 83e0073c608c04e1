// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/observability/observability.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/base/stop.h"
#include "launch/commands/json_output.h"
#include "launch/tools/commands/commands.h"

namespace shoal::launch {
namespace {

int Observe(const ObservabilityRequest& request, const std::string& json) {
  const JsonOutput output(json);
  InstallStopSignals();
  const Observability result = MeasureObservability(
      request,
      [&](const ObservabilityRow& row) {
        fmt::print(output.text(), "{}\n", ToText(request, row));
        std::fflush(output.text());
      },
      StopRequested);
  if (StopRequested()) return kInterruptedExit;
  output.Write(ToJson(result).dump(2) + "\n");
  return 0;
}

// "front,side" as a set of cameras.
std::vector<std::string> SplitAtCommas(const std::string& text) {
  return CLI::detail::split(text, ',');
}

}  // namespace

void AddObservabilityCommand(CLI::App& env, Action* chosen) {
  CLI::App* command =
      env.add_subcommand("observability",
                         "Measure how well each set of cameras shows a quantity: the error of a "
                         "small network, trained on frames of random play, on held-out episodes.");
  const auto request = std::make_shared<ObservabilityRequest>();
  const auto sets = std::make_shared<std::vector<std::string>>();
  const auto json = std::make_shared<std::string>();
  command->add_option("task", request->task, "Task, e.g. FetchPush")->required();
  command
      ->add_option("--tell", request->labels,
                   "Blocks, or differences of two blocks, as in sac.aux: object-grip")
      ->required();
  command->add_option("--cameras", *sets,
                      "Sets of cameras, each as front,side; every camera and pair by default");
  command->add_flag("--hide-goal", request->goal_hidden,
                    "Hide the goal's marker, as in runs that relabel goals");
  command->add_option("--width", request->width, "Pixels")
      ->check(CLI::Range(8, 1024))
      ->capture_default_str();
  command->add_option("--height", request->height, "Pixels")
      ->check(CLI::Range(8, 1024))
      ->capture_default_str();
  command->add_option("--quality", request->quality, "fast | native | reference")
      ->capture_default_str();
  command->add_option("--encoder", request->encoder, "Encoder, a value of network.encoder")
      ->capture_default_str();
  command->add_option("--samples", request->samples, "Frames, of which a fifth is held out")
      ->check(CLI::Range(20, 1'000'000))
      ->capture_default_str();
  command->add_option("--updates", request->updates, "Updates of the network")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  command->add_option("--seed", request->seed, "Seed of the episodes and the random actions")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--json", *json,
                      "Write the result as JSON to this file, which is replaced; - for standard "
                      "output (schema shoal-observability-1)");
  command->callback([=] {
    for (const std::string& set : *sets) request->cameras.push_back(SplitAtCommas(set));
    *chosen = [=] { return Observe(*request, *json); };
  });
}

}  // namespace shoal::launch
