// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/fetch_object_world.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include "actor/worlds/fetch_cameras.h"
#include "actor/worlds/site_motion.h"
#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::worlds {
namespace {

constexpr double kLeastDistance = 0.1;  // m, between object and grip
constexpr double kHighestGoal = 0.45;   // m, above the table
constexpr double kShareInTheAir = 0.5;
constexpr double kAboveGoal = 0.1;  // m, height of the grip above the goal (GripperAtGoal::kAbove)
constexpr double kFingersApart = 0.025;  // m, from the middle: half the width of the block
constexpr double kOutOfTheWay = 10;  // m, height from which the object falls while the arm moves
constexpr double kUnturned[4] = {1, 0, 0, 0};

constexpr FetchObjectSetup kPush{
    .model = "fetch_push.xml",
    .cameras = FetchCameras,
    .film_camera = FetchPushFilmCamera,
    .arm = {.base = {0.405, 0.48, 0}, .gripper_extra_height = 0, .block_gripper = true},
    .object = {1.25, 0.53, 0.4},
    .object_range = 0.15,
    .goal_range = 0.15};
// The puck starts 1 cm inside the table. The set-up leaves it tilted and spinning; that start is
// part of the published task.
constexpr FetchObjectSetup kSlide{
    .model = "fetch_slide.xml",
    .cameras = FetchSlideCameras,
    .film_camera = FetchSlideFilmCamera,
    .arm = {.base = {0.05, 0.48, 0}, .gripper_extra_height = -0.02, .block_gripper = true},
    .object = {1.7, 1.1, 0.41},
    .object_range = 0.1,
    .goal_range = 0.3,
    .goal_offset_x = 0.4,
    .gripper_at_goal = GripperAtGoal::kStart};
constexpr FetchObjectSetup kPickAndPlace{
    .model = "fetch_pick_and_place.xml",
    .cameras = FetchPickAndPlaceCameras,
    .film_camera = FetchPickAndPlaceFilmCamera,
    .arm = {.base = {0.405, 0.48, 0}, .gripper_extra_height = 0.2, .block_gripper = false},
    .object = {1.25, 0.53, 0.4},
    .object_range = 0.15,
    .goal_range = 0.15,
    .goal_in_the_air = true,
    .gripper_at_goal = GripperAtGoal::kAround};

}  // namespace

std::unique_ptr<World> MakeFetchPush(const WorldOptions& options) {
  return std::make_unique<FetchObjectWorld>(kPush, options);
}
std::unique_ptr<World> MakeFetchSlide(const WorldOptions& options) {
  return std::make_unique<FetchObjectWorld>(kSlide, options);
}
std::unique_ptr<World> MakeFetchPickAndPlace(const WorldOptions& options) {
  return std::make_unique<FetchObjectWorld>(kPickAndPlace, options);
}

FetchObjectWorld::FetchObjectWorld(const FetchObjectSetup& setup, const WorldOptions& options)
    : FetchWorld(setup.model, options, setup.arm, setup.cameras()),
      setup_(setup),
      object_site_(SiteId("object0")) {
  const int joint = JointId("object0:joint");
  if (model().jnt_type[joint] != mjJNT_FREE) {
    throw RuntimeError("{}: joint 'object0:joint' is not a free joint", source());
  }
  object_position_ = model().jnt_qposadr[joint];
  object_velocity_ = model().jnt_dofadr[joint];
  SetObject(setup.object);
  SetUpArm();
  table_height_ = PositionOfSite(*this, object_site_)[2];
}

void FetchObjectWorld::Reset(Random* random) {
  const std::array<double, 3>& grip = arm().initial_grip();
  std::array<double, 2> object{grip[0], grip[1]};
  while (std::hypot(object[0] - grip[0], object[1] - grip[1]) < kLeastDistance) {
    for (size_t i = 0; i < 2; ++i) {
      object[i] = grip[i] + random->Uniform(-setup_.object_range, setup_.object_range);
    }
  }
  std::array<double, 3> goal = grip;
  for (double& coordinate : goal) {
    coordinate += random->Uniform(-setup_.goal_range, setup_.goal_range);
  }
  goal[0] += setup_.goal_offset_x;
  goal[2] = table_height_;
  if (setup_.goal_in_the_air && random->Uniform() < kShareInTheAir) {
    goal[2] += random->Uniform(0, kHighestGoal);
  }
  ResetTo(goal, object);
}

void FetchObjectWorld::PlaceObject(const std::array<double, 2>& xy) {
  std::copy(xy.begin(), xy.end(), data().qpos + object_position_);
}

void FetchObjectWorld::SetObject(const std::array<double, 3>& position) {
  double* pose = data().qpos + object_position_;
  std::copy(position.begin(), position.end(), pose);
  std::copy_n(kUnturned, 4, pose + 3);
  std::fill_n(data().qvel + object_velocity_, 6, 0.0);
}

void FetchObjectWorld::MoveToGoal() {
  const bool around = setup_.gripper_at_goal == GripperAtGoal::kAround;
  std::array<double, 3> grip = goal();
  if (setup_.gripper_at_goal == GripperAtGoal::kAbove) grip[2] += kAboveGoal;
  // Keeps the object away, so that the arm neither meets nor pushes it.
  SetObject({goal()[0], goal()[1], kOutOfTheWay});
  if (setup_.gripper_at_goal != GripperAtGoal::kStart) {
    moving_arm().MoveTo(grip, around ? kFingersApart : 0);
  }
  CheckState();
  SetObject(goal());
  mj_forward(&model(), &data());
}

void FetchObjectWorld::Observe(std::span<double> observation, std::span<double> achieved_goal,
                               std::span<double> desired_goal) const {
  CHECK(observation.size() == 25) << observation.size();
  const double step_seconds = arm().StepSeconds();
  const std::array<double, 3> grip = arm().GripPosition(), grip_velocity = arm().GripVelocity();
  const std::array<double, 3> object = PositionOfSite(*this, object_site_);
  const SiteVelocity velocity = VelocityOfSite(*this, object_site_);
  std::array<double, 3> from_grip{}, velocity_from_grip{}, turning{};
  for (size_t i = 0; i < 3; ++i) {
    from_grip[i] = object[i] - grip[i];
    velocity_from_grip[i] = velocity.linear[i] * step_seconds - grip_velocity[i];
    turning[i] = velocity.angular[i] * step_seconds;
  }
  auto out = observation.begin();
  const auto append = [&out](const auto& numbers) {
    out = std::copy(numbers.begin(), numbers.end(), out);
  };
  append(grip);
  append(object);
  append(from_grip);
  append(arm().Fingers());
  append(EulerAngles(data().site_xmat + 9 * object_site_));
  append(velocity_from_grip);
  append(turning);
  append(grip_velocity);
  append(arm().FingerVelocities());
  std::copy(object.begin(), object.end(), achieved_goal.begin());
  std::copy(goal().begin(), goal().end(), desired_goal.begin());
}

}  // namespace shoal::worlds
