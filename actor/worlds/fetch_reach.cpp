#include "actor/worlds/fetch_reach.h"

#include <mujoco/mujoco.h>

#include <algorithm>

#include "actor/worlds/fetch_cameras.h"
#include "actor/worlds/model_loading.h"
#include "common/base/check.h"

namespace shoal::worlds {
namespace {

constexpr double kGoalRange = 0.15;  // m, each axis
constexpr FetchArmSetup kSetup{
    .base = {0.4049, 0.48, 0}, .gripper_extra_height = 0.2, .block_gripper = true};

}  // namespace

std::unique_ptr<World> MakeFetchReach(const std::string& model_file) {
  return std::make_unique<FetchReach>(model_file);
}

FetchReach::FetchReach(const std::string& model_file)
    : World(LoadModel("fetch_reach.xml", model_file)), arm_(this, kSetup) {
  target_site_ = SiteId("target0");
  arm_.SetUp();
}

void FetchReach::Reset(Random* random) {
  std::array<double, 3> goal = arm_.initial_grip();
  for (double& coordinate : goal) coordinate += random->Uniform(-kGoalRange, kGoalRange);
  ResetTo(goal);
}

void FetchReach::ResetTo(const std::array<double, 3>& goal) {
  goal_ = goal;
  arm_.RestoreInitialState();
  // The target's marker sits on a body that neither moves nor turns.
  const double* body = model().body_pos + 3 * model().site_bodyid[target_site_];
  for (int i = 0; i < 3; ++i) {
    model().site_pos[3 * target_site_ + i] = goal[static_cast<size_t>(i)] - body[i];
  }
  mj_forward(&model(), &data());
}

World::Outcome FetchReach::Step(std::span<const double> action) {
  arm_.Act(action);
  Advance(FetchArm::kEngineStepsPerEnvStep);
  arm_.FinishStep();
  return {};
}

void FetchReach::Observe(std::span<double> observation, std::span<double> achieved_goal,
                         std::span<double> desired_goal) const {
  CHECK(observation.size() == 10) << observation.size();
  const std::array<double, 3> grip = arm_.GripPosition();
  auto out = std::copy_n(grip.begin(), 3, observation.begin());
  out = std::copy_n(arm_.Fingers().begin(), 2, out);
  out = std::copy_n(arm_.GripVelocity().begin(), 3, out);
  std::copy_n(arm_.FingerVelocities().begin(), 2, out);
  std::copy(grip.begin(), grip.end(), achieved_goal.begin());
  std::copy(goal_.begin(), goal_.end(), desired_goal.begin());
}

std::span<const CameraView> FetchReach::cameras() const { return FetchCameras(); }

}  // namespace shoal::worlds
