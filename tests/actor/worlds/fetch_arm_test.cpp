// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/fetch_arm.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <array>
#include <cmath>

#include "actor/worlds/fetch_reach.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::worlds {
namespace {

// Values of the original environment on the same engine.
constexpr std::array<double, 3> kInitialGrip{1.3418550217, 0.7491005081, 0.5347069462};

constexpr std::array<double, 4> kForward{1, 0, 0, 0};

TEST(FetchArm, StartsWhereTheOriginalDoes) {
  const FetchReach world;
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(world.arm().initial_grip()[i], kInitialGrip[i], 1e-8) << i;
  }
}

TEST(FetchArm, TheGripPointsDown) {
  const FetchReach world;
  const double* matrix = world.data().xmat + 9 * world.BodyId("robot0:gripper_link");
  EXPECT_NEAR(matrix[6], -1, 1e-3);  // the gripper's x axis along -z
}

TEST(FetchArm, FollowsAFullActionWithALag) {
  FetchReach world;
  world.ResetTo({1.4, 0.7, 0.5});
  const double start = world.arm().GripPosition()[0];
  world.Step(kForward);
  const double first = world.arm().GripPosition()[0];
  world.Step(kForward);
  const double second = world.arm().GripPosition()[0];
  EXPECT_NEAR(first - start, 0.030, 0.002);
  EXPECT_NEAR(second - first, 0.033, 0.002);
}

TEST(FetchArm, VelocityIsMovementPerEnvStep) {
  FetchReach world;
  world.ResetTo({1.4, 0.7, 0.5});
  for (int i = 0; i < 3; ++i) world.Step(kForward);
  const double velocity = world.arm().GripVelocity()[0];
  // One engine step further moves the site by a twentieth of it.
  const double before = world.arm().GripPosition()[0];
  mj_step(&world.model(), &world.data());
  mj_kinematics(&world.model(), &world.data());
  const double moved = world.arm().GripPosition()[0] - before;
  EXPECT_NEAR(moved * FetchArm::kEngineStepsPerEnvStep, velocity, 0.1 * std::fabs(velocity));
  EXPECT_GT(std::fabs(velocity), 1e-3);
  EXPECT_NEAR(world.arm().StepSeconds(), 0.04, 1e-12);
}

TEST(FetchArm, ABlockedGripperStaysShutWhateverTheAction) {
  FetchReach open, shut;
  open.ResetTo({1.4, 0.7, 0.5});
  shut.ResetTo({1.4, 0.7, 0.5});
  for (int i = 0; i < 5; ++i) {
    open.Step(std::array<double, 4>{0.3, 0, 0, 1});
    shut.Step(std::array<double, 4>{0.3, 0, 0, -1});
  }
  EXPECT_EQ(open.arm().Fingers(), (std::array<double, 2>{0, 0}));
  EXPECT_EQ(open.arm().GripPosition(), shut.arm().GripPosition());
}

TEST(FetchArm, AModelWithoutTheArmIsRefusedNamingWhatItLacks) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "empty.xml";
  WriteFileAtomically(path, "<mujoco><worldbody/></mujoco>");
  try {
    FetchReach world({.model = path.string()});
    FAIL() << "made a Fetch world of an empty model";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("robot0:grip"));
  }
}

}  // namespace
}  // namespace shoal::worlds
