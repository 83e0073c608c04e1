// SPDX-License-Identifier: Apache-2.0
#include "tests/actor/worlds/parity/state_reference.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "actor/worlds/tools/measurement_reader.h"
#include "actor/worlds/tools/reference_file.h"

namespace shoal::worlds {
namespace {

constexpr size_t kMostStates = 100'000;

struct Shape {
  const char* environment;
  size_t joints, observation, action;
};

constexpr Shape kShapes[] = {
    {"Hopper", 6, 11, 3},      {"cartpole_swingup", 2, 5, 1},  {"reacher_easy", 2, 6, 2},
    {"cheetah_run", 9, 17, 6}, {"ball_in_cup_catch", 4, 8, 2}, {"finger_spin", 3, 9, 2},
    {"walker_walk", 9, 24, 6},
};

const Shape* FindShape(const std::string& environment) {
  const auto* found = std::ranges::find_if(
      kShapes, [&](const Shape& shape) { return environment == shape.environment; });
  return found == std::end(kShapes) ? nullptr : found;
}

StateSnapshot ReadSnapshot(const MeasurementReader& from, const Shape& shape) {
  return {.observation = from.Numbers("obs", shape.observation),
          .qpos = from.Numbers("qpos", shape.joints),
          .qvel = from.Numbers("qvel", shape.joints),
          .contacts = static_cast<int>(from.Number("ncon"))};
}

StateStep ReadStateStep(const MeasurementReader& from, const Shape& shape, bool hopper) {
  StateStep step;
  step.action = from.Numbers("action", shape.action);
  for (const double component : step.action) {
    if (std::fabs(component) > 1) {
      throw from.Fault("key '" + from.Path("action") + "'", "has a component outside [-1, 1]");
    }
  }
  step.after = ReadSnapshot(from, shape);
  step.reward = from.Number(hopper ? "reward_v5" : "reward");
  if (hopper) {
    step.reward_hopper_v4 = from.Number("reward_v4");
    step.healthy = from.Number("healthy") != 0;
  }
  return step;
}

}  // namespace

std::string StateEnvironments() {
  std::vector<std::string> names;
  for (const Shape& shape : kShapes) names.push_back(shape.environment);
  return fmt::format("{}", fmt::join(names, ", "));
}

bool IsStateEnvironment(const std::string& environment) {
  return FindShape(environment) != nullptr;
}

StateTrajectory ReadStateReference(const std::filesystem::path& path) {
  const nlohmann::json document = ReadJson(path);
  const MeasurementReader root(path, document, "");
  const std::string format = root.Text("format");
  if (format != kReferenceFormat) {
    throw root.Fault("key 'format'",
                     fmt::format("is '{}'; expected '{}'", format, kReferenceFormat));
  }
  StateTrajectory trajectory;
  trajectory.environment = root.Text("env");
  const Shape* shape = FindShape(trajectory.environment);
  if (shape == nullptr) {
    throw root.Fault("key 'env'", fmt::format("is '{}'; expected one of {}", trajectory.environment,
                                              StateEnvironments()));
  }
  const bool hopper = trajectory.environment == "Hopper";
  if (hopper) trajectory.variant = root.Text("variant");
  trajectory.sequence = root.Text("sequence");
  const std::string drawn = hopper ? "initial" : "sampled";
  trajectory.drawn_qpos = root.Numbers(drawn + "_qpos", shape->joints);
  trajectory.drawn_qvel = root.Numbers(drawn + "_qvel", shape->joints);
  if (trajectory.environment == "reacher_easy") trajectory.target = root.Numbers<2>("target_xy");
  trajectory.reset = ReadSnapshot(root.Object("reset"), *shape);
  const nlohmann::json& steps = root.At("trajectory");
  if (!steps.is_array() || steps.empty() || steps.size() > kMostStates) {
    throw root.Fault("key 'trajectory'", "is not a list of steps");
  }
  for (size_t i = 0; i < steps.size(); ++i) {
    const MeasurementReader step(path, steps[i], fmt::format("trajectory[{}]", i));
    trajectory.steps.push_back(ReadStateStep(step, *shape, hopper));
  }
  return trajectory;
}

}  // namespace shoal::worlds
