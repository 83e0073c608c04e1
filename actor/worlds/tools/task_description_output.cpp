// SPDX-License-Identifier: Apache-2.0
// Prints a TaskDescription.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "actor/worlds/tools/task_description.h"
#include "actor/worlds/tools/task_table.h"
#include "common/base/build_info.h"
#include "common/base/clock.h"
#include "common/base/error.h"

namespace shoal::worlds {
namespace {

using nlohmann::ordered_json;
using tasks::Block;
using tasks::Component;
using tasks::Task;

// People see the largest changes only, and none below this share of the largest.
constexpr size_t kShownChanges = 3;
constexpr double kShownShare = 0.1;

std::string RewardFormula(const Task& task) {
  if (task.goal_size() == 0) return task.physics_reward();
  if (task.reward_kind() == tasks::RewardKind::kDense) {
    return "-|achieved_goal - desired_goal|";
  }
  return fmt::format("-1 while |achieved_goal - desired_goal| > {}, else 0",
                     task.distance_threshold());
}

ordered_json NumberOrNull(double number) {
  return std::isfinite(number) ? ordered_json(number) : ordered_json(nullptr);
}

ordered_json ComponentJson(const Component& component) {
  return {{"name", component.name},
          {"unit", component.unit},
          {"meaning", component.meaning},
          {"low", NumberOrNull(component.low)},
          {"high", NumberOrNull(component.high)}};
}

ordered_json BlockJson(const Block& block, const std::vector<MeasuredRange>& ranges) {
  ordered_json components = ordered_json::array();
  for (size_t i = 0; i < ranges.size(); ++i) {
    components.push_back(ComponentJson(block.components[i]));
    components.back()["measured_low"] = ranges[i].low;
    components.back()["measured_high"] = ranges[i].high;
  }
  return {{"name", block.name},
          {"shape", {block.size()}},
          {"dtype", "float32"},
          {"components", components}};
}

ordered_json CameraJson(const CameraView& camera) {
  if (camera.model_camera >= 0) {
    return {{"name", camera.name}, {"model_camera", camera.model_camera}};
  }
  return {{"name", camera.name},
          {"lookat", camera.lookat},
          {"distance", camera.distance},
          {"azimuth", camera.azimuth_degrees},
          {"elevation", camera.elevation_degrees}};
}

ordered_json ProbeJson(const AxisProbe& probe, const Task& task) {
  ordered_json change = ordered_json::object();
  for (size_t i = 0; i < probe.change.size(); ++i) {
    change[task.observation().components[i].name] = probe.change[i];
  }
  return {{"axis", task.action()[static_cast<size_t>(probe.axis)].name},
          {"command", probe.command},
          {"env_steps", probe.env_steps},
          {"change", change}};
}

std::string Bounds(double low, double high) {
  if (std::isinf(low) && std::isinf(high)) return "unbounded";
  return fmt::format("[{}, {}]", low, high);
}

std::string BlockText(const Block& block, const std::vector<MeasuredRange>& ranges) {
  if (block.size() == 0) return "";
  std::string text = fmt::format("  {} ({}) float32\n", block.name, block.size());
  for (size_t i = 0; i < ranges.size(); ++i) {
    const Component& component = block.components[i];
    text += fmt::format("    {:>2} {:<24} {:<7} {:<10} {:>9.4f} .. {:<9.4f} {}\n", i,
                        component.name, component.unit, Bounds(component.low, component.high),
                        ranges[i].low, ranges[i].high, component.meaning);
  }
  return text;
}

// The blocks that observation.proprioception may name: "grip 0-2, fingers 3-4".
std::string StateBlocksText(const Task& task) {
  std::string text;
  int first = 0;
  for (const Block& block : task.state_blocks()) {
    const int last = first + block.size() - 1;
    text += fmt::format("{}{} {}-{}", text.empty() ? "" : ", ", block.name, first, last);
    first = last + 1;
  }
  return fmt::format("    by name: {}\n", text);
}

// "grip_x +0.1523 m, grip_velocity_x +0.0311 m/step"
std::string LargestChanges(const AxisProbe& probe, const Block& block) {
  std::vector<size_t> order(probe.change.size());
  std::iota(order.begin(), order.end(), size_t{0});
  const auto size = [&](size_t i) { return std::fabs(probe.change[i]); };
  std::ranges::stable_sort(order, [&](size_t a, size_t b) { return size(a) > size(b); });
  std::string text;
  for (size_t rank = 0; rank < std::min(order.size(), kShownChanges); ++rank) {
    const size_t i = order[rank];
    if (size(i) == 0 || size(i) < kShownShare * size(order[0])) break;
    const Component& component = block.components[i];
    text += fmt::format("{}{} {:+.4f}{}{}", text.empty() ? "" : ", ", component.name,
                        probe.change[i], component.unit.empty() ? "" : " ", component.unit);
  }
  return text.empty() ? "nothing moves" : text;
}

std::string ActionText(const TaskDescription& description) {
  const Task& task = *description.task;
  std::string text = fmt::format(
      "  action ({}) float32, with what it changes against no action from the same start\n",
      task.action_size());
  for (const AxisProbe& probe : description.probes) {
    const Component& axis = task.action()[static_cast<size_t>(probe.axis)];
    if (probe.command < 0) {
      text += fmt::format("    {:>2} {:<24} {:<7} {:<10} {}\n", probe.axis, axis.name, axis.unit,
                          Bounds(axis.low, axis.high), axis.meaning);
    }
    text += fmt::format("       {:+.0f} for {} steps: {}\n", probe.command, probe.env_steps,
                        LargestChanges(probe, task.observation()));
  }
  return text;
}

}  // namespace

ordered_json ToJson(const TaskDescription& description) {
  const Task& task = *description.task;
  ordered_json action = ordered_json::array(), probes = ordered_json::array();
  for (const Component& axis : task.action()) action.push_back(ComponentJson(axis));
  for (const AxisProbe& probe : description.probes) probes.push_back(ProbeJson(probe, task));
  ordered_json blocks = ordered_json::array(), cameras = ordered_json::array();
  blocks.push_back(BlockJson(task.observation(), description.observation));
  if (task.goal_size() > 0) {
    blocks.push_back(BlockJson(task.achieved_goal(), description.achieved_goal));
    blocks.push_back(BlockJson(task.desired_goal(), description.desired_goal));
  }
  for (const CameraView& camera : description.cameras) cameras.push_back(CameraJson(camera));
  ordered_json state_blocks = ordered_json::array();
  for (const Block& block : task.state_blocks()) {
    state_blocks.push_back({{"name", block.name}, {"size", block.size()}});
  }
  const bool goals = task.goal_size() > 0;
  return {
      {"schema", "shoal-env-1"},
      {"task", task.name()},
      {"world", task.world()},
      {"model_fingerprint", description.fingerprint},
      {"episode_length", task.EnvStepsPerEpisode(task.action_repeat())},
      {"action_repeat", task.action_repeat()},
      {"env_step_seconds", description.env_step_seconds},
      {"reward",
       {{"kind", RewardName(task)},
        {"formula", RewardFormula(task)},
        {"threshold", goals ? ordered_json(task.distance_threshold()) : ordered_json(nullptr)}}},
      {"action", action},
      {"blocks", blocks},
      {"state_blocks", state_blocks},
      {"measured_over_env_steps", description.random_env_steps},
      {"constant_numbers", ToJson(description.constant)},
      {"probes", probes},
      {"cameras", cameras},
      {"commit", BuildCommit()},
      {"created", UtcTimestamp()}};
}

std::string ToText(const TaskDescription& description) {
  const Task& task = *description.task;
  std::string text = fmt::format("{}: episodes of {} env steps of {:.4g} s, model {}\n",
                                 task.name(), task.EnvStepsPerEpisode(task.action_repeat()),
                                 description.env_step_seconds, description.fingerprint);
  text += fmt::format("  reward {}: {}\n", RewardName(task), RewardFormula(task));
  if (task.goal_size() > 0) {
    text +=
        fmt::format("  success: |achieved_goal - desired_goal| < {}\n", task.distance_threshold());
  }
  text += ActionText(description);
  text += fmt::format("  blocks: index, name, unit, bounds, range over {} random env steps\n",
                      description.random_env_steps);
  text += BlockText(task.observation(), description.observation);
  text += StateBlocksText(task);
  text += BlockText(task.achieved_goal(), description.achieved_goal);
  text += BlockText(task.desired_goal(), description.desired_goal);
  text += ToText(description.constant, description.observations);
  text += "  cameras\n";
  for (const CameraView& camera : description.cameras) {
    if (camera.model_camera >= 0) {
      text += fmt::format("    {:<12} camera {} of the model\n", camera.name, camera.model_camera);
      continue;
    }
    text += fmt::format(
        "    {:<12} looks at ({}, {}, {}) m from {} m, azimuth {}, elevation {} degrees\n",
        camera.name, camera.lookat[0], camera.lookat[1], camera.lookat[2], camera.distance,
        camera.azimuth_degrees, camera.elevation_degrees);
  }
  return text;
}

}  // namespace shoal::worlds
