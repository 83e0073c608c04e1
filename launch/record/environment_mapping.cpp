// SPDX-License-Identifier: Apache-2.0
#include "launch/record/environment_mapping.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/base/bounded_json.h"
#include "common/base/check.h"
#include "launch/record/run_inputs.h"

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;
using tasks::ArraySpace;

tasks::EnvironmentDescription EnvironmentOf(const RunConfig& run) {
  CHECK(!run.spec.environment.empty()) << run.spec.task;
  return tasks::EnvironmentFromJson(ParseBoundedJson<nlohmann::json>(run.spec.environment));
}

// "float32 (3)".
std::string TypeText(const ArraySpace& space) {
  return fmt::format("{} ({})", tasks::NameOf(space.type), fmt::join(space.shape, ", "));
}

int ChannelsOfCamera(const ObservationSpec& spec) {
  return spec.channels / static_cast<int>(spec.cameras.size());
}

// How the image becomes a frame: "resized by averaging over areas, made grey".
std::string ConversionText(const tasks::ImageLayout& image, const ObservationSpec& spec) {
  const bool resized = image.height != spec.height || image.width != spec.width;
  const bool grey = image.channels == 3 && ChannelsOfCamera(spec) == 1;
  std::string text = resized ? "resized by averaging over areas" : "";
  if (grey) text += std::string(text.empty() ? "" : ", ") + "made grey";
  return text.empty() ? "unchanged" : text;
}

std::string ImageText(const ArraySpace& space, const tasks::ImageLayout& image,
                      const ObservationSpec& spec) {
  if (std::ranges::count(spec.cameras, space.name) == 0) {
    return "image that is not used (observation.cameras, observation.pixels)";
  }
  return fmt::format("frame of camera '{}', {} x {} x {}, {}", space.name, ChannelsOfCamera(spec),
                     spec.height, spec.width, ConversionText(image, spec));
}

std::string BlockText(const ArraySpace& space, const ObservationSpec& spec) {
  const bool observed = spec.Observed(space.name).has_value();
  return fmt::format(
      "block '{}' of {} numbers in {}, {}", space.name, space.size(), BoundsText(space),
      observed ? "which the policy sees" : "recorded, which the policy does not see");
}

std::string ArrayText(const ArraySpace& space, const ObservationSpec& spec) {
  const auto image = ImageLayoutOf(space);
  return fmt::format("  {}: {} -> {}\n", space.name, TypeText(space),
                     image ? ImageText(space, *image, spec) : BlockText(space, spec));
}

std::string ActionText(const ArraySpace& action) {
  std::string text = fmt::format("  action: {} numbers, each of [-1, 1] as a -> {}\n",
                                 action.size(), TypeText(action));
  for (int i = 0; i < action.size(); ++i) {
    const double low = action.Low(i), high = action.High(i);
    text += fmt::format("    number {}: {:g} + (a + 1) / 2 * {:g}, in [{:g}, {:g}]\n", i, low,
                        high - low, low, high);
  }
  return text;
}

std::string RewardText(const tasks::EnvironmentDescription& environment) {
  if (!environment.goal) return "the environment's own";
  if (environment.goal->reward == tasks::RewardKind::kDense) {
    return "the environment's own; the replay computes minus the distance for other goals";
  }
  return fmt::format(
      "the environment's own; the replay computes -1 beyond a distance of {:g}, else 0, for other "
      "goals",
      environment.goal->threshold);
}

ordered_json ArrayJson(const ArraySpace& space, const ObservationSpec& spec) {
  ordered_json json{
      {"name", space.name}, {"shape", space.shape}, {"dtype", tasks::NameOf(space.type)}};
  if (ImageLayoutOf(space)) {
    const bool used = std::ranges::count(spec.cameras, space.name) > 0;
    json["becomes"] = used ? "frame" : "nothing";
    if (used) json["frame"] = {ChannelsOfCamera(spec), spec.height, spec.width};
    return json;
  }
  json["becomes"] = "block";
  json["observed"] = spec.Observed(space.name).has_value();
  return json;
}

}  // namespace

std::string BoundsText(const ArraySpace& space) {
  double low = space.Low(0), high = space.High(0);
  for (int i = 1; i < space.size(); ++i) {
    low = std::min(low, space.Low(i));
    high = std::max(high, space.High(i));
  }
  return fmt::format("[{:g}, {:g}]", low, high);
}

std::string DescribeMapping(const RunConfig& run) {
  const tasks::EnvironmentDescription environment = EnvironmentOf(run);
  std::string text = fmt::format("environment {}, task {}\n", environment.id, environment.task);
  for (const ArraySpace& space : environment.observation) text += ArrayText(space, run.spec);
  if (run.spec.HasPixels()) {
    text += fmt::format("  the policy sees the last {} frame(s)\n", run.spec.stack);
  }
  text += ActionText(environment.action);
  text += environment.episode_steps > 0
              ? fmt::format("  episodes: at most {} steps", environment.episode_steps)
              : "  episodes: without a time limit that Shoal knows";
  text += environment.success ? "; steps report success\n" : "; success is not reported\n";
  return text + fmt::format("  rewards: {}\n  specification: {:016x}\n", RewardText(environment),
                            run.spec.Hash());
}

ordered_json MappingJson(const RunConfig& run) {
  const tasks::EnvironmentDescription environment = EnvironmentOf(run);
  ordered_json observation = ordered_json::array(), action = ordered_json::array();
  for (const ArraySpace& space : environment.observation) {
    observation.push_back(ArrayJson(space, run.spec));
  }
  for (int i = 0; i < environment.action.size(); ++i) {
    action.push_back({{"low", environment.action.Low(i)}, {"high", environment.action.High(i)}});
  }
  return {{"schema", "shoal-env-mapping-1"},
          {"environment", ToJson(environment)},
          {"preset", run.config.preset},
          {"observation", observation},
          {"stack", run.spec.stack},
          {"action", action},
          {"specification", fmt::format("{:016x}", run.spec.Hash())},
          {"inputs", InputsJson(run)}};
}

}  // namespace shoal::launch
