// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/reference_file.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "actor/worlds/tools/measurement_reader.h"
#include "common/tasks/task_registry.h"

namespace shoal::worlds {
namespace {

using nlohmann::json;

// A published name is the name of a Shoal task with this version.
constexpr std::string_view kVersion = "-v4";
constexpr const char* kReplayable[] = {"FetchReach-v4", "FetchPush-v4", "FetchSlide-v4",
                                       "FetchPickAndPlace-v4"};
constexpr size_t kActionSize = 4, kMostSteps = 100'000;

struct Sizes {
  size_t observation, qpos, qvel;
};

ReferenceState ReadState(const MeasurementReader& from, const Sizes& sizes) {
  ReferenceState state;
  state.observation = from.Numbers("obs", sizes.observation);
  state.achieved_goal = from.Numbers<3>("achieved_goal");
  state.qpos = from.Numbers("qpos", sizes.qpos);
  state.qvel = from.Numbers("qvel", sizes.qvel);
  state.grip_quaternion = from.Numbers<4>("grip_xquat");
  state.contacts = static_cast<int>(from.Number("ncon"));
  return state;
}

ReferenceStep ReadStep(const MeasurementReader& from, const Sizes& sizes) {
  ReferenceStep step;
  step.action = from.Numbers("action", kActionSize);
  for (const double component : step.action) {
    if (std::fabs(component) > 1) {
      throw from.Fault("key '" + from.Path("action") + "'", "has a component outside [-1, 1]");
    }
  }
  step.state = ReadState(from, sizes);
  step.distance = from.Number("distance");
  step.reward_sparse = from.Number("reward_sparse");
  step.reward_dense = from.Number("reward_dense");
  step.success = from.Number("is_success") != 0;
  return step;
}

void ReadIdentity(const MeasurementReader& root, ReferenceTrajectory* trajectory) {
  const std::string format = root.Text("format");
  if (format != kReferenceFormat) {
    throw root.Fault("key 'format'",
                     fmt::format("is '{}'; expected '{}'", format, kReferenceFormat));
  }
  trajectory->environment = root.Text("env");
  if (std::ranges::find(kReplayable, trajectory->environment) == std::end(kReplayable)) {
    throw root.Fault("key 'env'",
                     fmt::format("is '{}', which cannot be replayed; known: {}",
                                 trajectory->environment, fmt::join(kReplayable, ", ")));
  }
  trajectory->task =
      trajectory->environment.substr(0, trajectory->environment.size() - kVersion.size());
  trajectory->has_object = trajectory->task != "FetchReach";
  trajectory->sequence = root.Text("sequence");
}

}  // namespace

ReferenceTrajectory ReadReference(const std::filesystem::path& path) {
  const json document = ReadJson(path);
  const MeasurementReader root(path, document, "");
  ReferenceTrajectory trajectory;
  ReadIdentity(root, &trajectory);
  trajectory.initial_grip = root.Numbers<3>("initial_gripper_xpos");
  trajectory.desired_goal = root.Numbers<3>("desired_goal");
  trajectory.joint_names = root.Names("joint_names");
  // The object's joint is the last one: seven coordinates, six velocities.
  const size_t joints = trajectory.joint_names.size();
  Sizes sizes{static_cast<size_t>(tasks::FindTask(trajectory.task).observation().size()), joints,
              joints};
  if (trajectory.has_object) {
    trajectory.table_height = root.Number("height_offset");
    trajectory.object_xy = root.Numbers<2>("object_xy");
    sizes.qpos += 6;
    sizes.qvel += 5;
  }
  trajectory.reset = ReadState(root.Object("reset"), sizes);

  const json& steps = root.At("trajectory");
  if (!steps.is_array() || steps.empty() || steps.size() > kMostSteps) {
    throw root.Fault("key 'trajectory'", "is not a list of steps");
  }
  for (size_t i = 0; i < steps.size(); ++i) {
    const MeasurementReader step(path, steps[i], fmt::format("trajectory[{}]", i));
    trajectory.steps.push_back(ReadStep(step, sizes));
  }
  return trajectory;
}

}  // namespace shoal::worlds
