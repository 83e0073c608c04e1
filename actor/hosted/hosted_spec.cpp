// SPDX-License-Identifier: Apache-2.0
#include "actor/hosted/hosted_spec.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "common/base/error.h"
#include "common/base/random.h"
#include "common/config/on_policy.h"

namespace shoal::hosted {
namespace {

using tasks::ArraySpace;
using tasks::EnvironmentDescription;

// Refuses keys that apply only to Shoal's own worlds.
void RefuseWorldKeys(const Config& config) {
  const Config usual;
  const std::pair<const char*, bool> keys[] = {
      {"model", config.model != usual.model},
      {"physics", config.physics != usual.physics},
      {"task_library", config.task_library != usual.task_library},
      {"distance_threshold", config.distance_threshold != usual.distance_threshold},
      {"randomization.body_mass", !config.randomization.body_mass.empty()},
      {"observation.custom_cameras", !config.observation.custom_cameras.empty()},
      {"observation.quality", config.observation.quality != usual.observation.quality},
      {"observation.goal_mode", config.observation.goal_mode == "image"}};
  for (const auto& [key, is_set] : keys) {
    if (!is_set) continue;
    throw UsageError(
        "{} belongs to Shoal's own worlds; environment {} takes its options by env.kwargs, "
        "expected the key unset",
        key, config.env.id);
  }
}

std::vector<std::string> ChooseImages(const EnvironmentDescription& environment,
                                      const std::vector<std::string>& asked) {
  std::vector<std::string> images = ImagesOf(environment);
  if (images.empty()) {
    throw UsageError(
        "observation.pixels is true, but environment {} observes no image (uint8, HxWxC or CxHxW); "
        "expected false",
        environment.id);
  }
  // The default names cameras of Shoal's own worlds; here it selects every image.
  if (asked == ObservationConfig().cameras) return images;
  for (const std::string& name : asked) {
    if (std::ranges::count(images, name) > 0) continue;
    throw UsageError("observation.cameras names '{}'; the images of environment {} are: {}", name,
                     environment.id, fmt::join(images, ", "));
  }
  return asked;
}

void AddPixels(const EnvironmentDescription& environment, const ObservationConfig& observation,
               ObservationSpec* spec) {
  spec->cameras = ChooseImages(environment, observation.cameras);
  spec->height = observation.height;
  spec->width = observation.width;
  for (const std::string& name : spec->cameras) {
    const int channels = ImageLayoutOf(*environment.Find(name))->channels;
    if (!observation.grey && channels != 3) {
      throw UsageError(
          "image '{}' of environment {} is grey; expected observation.grey = true, which makes "
          "every image grey",
          name, environment.id);
    }
    spec->channels += observation.grey ? 1 : 3;
  }
}

void AddBlocks(const EnvironmentDescription& environment, const ObservationConfig& observation,
               ObservationSpec* spec) {
  const StateBlocks& seen = observation.proprioception;
  // A policy without pixels observes every block unless the key names some.
  const bool all = seen.all || (!seen && !spec->HasPixels());
  std::set<std::string> names(seen.names.begin(), seen.names.end());
  const tasks::Task task = TaskOf(environment);
  std::string known;
  for (const tasks::Block& block : task.state_blocks()) {
    spec->blocks.push_back({block.name, block.size(), all || names.erase(block.name) > 0});
    known += (known.empty() ? "" : ", ") + block.name;
  }
  if (!names.empty()) {
    throw UsageError("observation.proprioception names a block '{}'; environment {} has: {}",
                     *names.begin(), environment.id, known.empty() ? "none" : known);
  }
  const std::string& mode = observation.goal_mode;
  if (task.goal_size() == 0) {
    if (mode == "none") return;
    throw UsageError(
        "observation.goal_mode is '{}', but environment {} has no goals that Shoal knows{}{}; "
        "expected none",
        mode, environment.id, environment.no_goal.empty() ? "" : ": ", environment.no_goal);
  }
  spec->blocks.push_back({tasks::kAchievedGoal, task.goal_size(), mode == "both"});
  spec->blocks.push_back(
      {tasks::kDesiredGoal, task.goal_size(), mode == "both" || mode == "desired"});
}

}  // namespace

std::vector<std::string> ImagesOf(const EnvironmentDescription& environment) {
  std::vector<std::string> images;
  for (const ArraySpace& space : environment.observation) {
    if (ImageLayoutOf(space)) images.push_back(space.name);
  }
  return images;
}

ObservationSpec SpecOf(const EnvironmentDescription& environment, const Config& config) {
  RefuseWorldKeys(config);
  if (config.end_on_success && !environment.success) {
    throw UsageError(
        "end_on_success is true, but the steps of environment {} report no is_success; expected "
        "false",
        environment.id);
  }
  ObservationSpec spec;
  spec.task = environment.task;
  spec.stack = config.observation.pixels ? config.observation.stack : 1;
  spec.action_size = environment.action.size();
  spec.drawn_actions = LearnsOnPolicy(config);
  spec.environment = ToJson(environment).dump();
  spec.model_fingerprint =
      fmt::format("{:016x}", HashBytes(spec.environment.data(), spec.environment.size()));
  if (config.observation.pixels) AddPixels(environment, config.observation, &spec);
  AddBlocks(environment, config.observation, &spec);
  if (spec.HasPixels() || spec.VectorSize() > 0) return spec;
  throw UsageError(
      "environment {}: the policy would observe nothing; its images need "
      "observation.pixels = true",
      environment.id);
}

}  // namespace shoal::hosted
