// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/fetch_reach.h"

#include <algorithm>

#include "actor/worlds/fetch_cameras.h"
#include "common/base/check.h"

namespace shoal::worlds {
namespace {

constexpr double kGoalRange = 0.15;  // m, each axis
constexpr FetchArmSetup kSetup{
    .base = {0.4049, 0.48, 0}, .gripper_extra_height = 0.2, .block_gripper = true};

}  // namespace

std::unique_ptr<World> MakeFetchReach(const WorldOptions& options) {
  return std::make_unique<FetchReach>(options);
}

FetchReach::FetchReach(const WorldOptions& options)
    : FetchWorld("fetch_reach.xml", options, kSetup, FetchCameras()) {
  SetUpArm();
}

void FetchReach::Reset(Random* random) {
  std::array<double, 3> goal = arm().initial_grip();
  for (double& coordinate : goal) coordinate += random->Uniform(-kGoalRange, kGoalRange);
  ResetTo(goal);
}

void FetchReach::MoveToGoal() {
  moving_arm().MoveTo(goal(), /*opening=*/0);
  CheckState();
}

void FetchReach::Observe(std::span<double> observation, std::span<double> achieved_goal,
                         std::span<double> desired_goal) const {
  CHECK(observation.size() == 10) << observation.size();
  const std::array<double, 3> grip = arm().GripPosition();
  auto out = std::copy_n(grip.begin(), 3, observation.begin());
  out = std::copy_n(arm().Fingers().begin(), 2, out);
  out = std::copy_n(arm().GripVelocity().begin(), 3, out);
  std::copy_n(arm().FingerVelocities().begin(), 2, out);
  std::copy(grip.begin(), grip.end(), achieved_goal.begin());
  std::copy(goal().begin(), goal().end(), desired_goal.begin());
}

}  // namespace shoal::worlds
