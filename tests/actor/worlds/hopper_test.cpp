// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/hopper.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>

#include "actor/worlds/custom_cameras.h"
#include "actor/worlds/world_registry.h"
#include "common/base/error.h"
#include "tests/support/paths.h"

namespace shoal::worlds {
namespace {

constexpr std::array<double, 3> kNothing{};

double Mass(const World& world, const char* body) {
  return world.model().body_mass[world.BodyId(body)];
}

// Rounded to the digits in which they are published.
TEST(Hopper, MassesAreThoseOfExactCapsules) {
  const Hopper hopper(HopperV5(), "");
  EXPECT_NEAR(Mass(hopper, "torso"), 3.6651914292, 1e-9);
  EXPECT_NEAR(Mass(hopper, "thigh"), 4.0578905109, 1e-9);
  EXPECT_NEAR(Mass(hopper, "leg"), 2.7813567, 1e-6);
  EXPECT_NEAR(Mass(hopper, "foot"), 5.3155747, 1e-6);
}

TEST(Hopper, TheCustomPairHasTheOldMassesAndDiffersByAKilogramOfTorso) {
  const Hopper target(CustomHopperTarget(), ""), source(CustomHopperSource(), "");
  EXPECT_NEAR(Mass(target, "torso"), 3.53429174, 1e-8);
  EXPECT_NEAR(Mass(source, "torso"), 2.53429174, 1e-8);
  for (const Hopper* hopper : {&target, &source}) {
    EXPECT_NEAR(Mass(*hopper, "thigh"), 3.92699082, 1e-8);
    EXPECT_NEAR(Mass(*hopper, "leg"), 2.71433605, 1e-8);
    EXPECT_NEAR(Mass(*hopper, "foot"), 5.08938010, 1e-8);
    const double* inertia = hopper->model().body_inertia + 3 * hopper->BodyId("foot");
    EXPECT_NEAR(inertia[0], 0.09046373126, 1e-10);
    EXPECT_NEAR(inertia[1], 0.09046373126, 1e-10);
    EXPECT_NEAR(inertia[2], 0.009160884178, 1e-10);
  }
  // Values that the compiler derived from the torso's mass are unchanged.
  const int torso = target.BodyId("torso");
  EXPECT_EQ(source.model().body_invweight0[2 * torso], target.model().body_invweight0[2 * torso]);
}

TEST(Hopper, EveryVariantHasAFingerprintOfItsOwnAndV4SharesItsModelWithV5) {
  const Hopper v4(HopperV4(), ""), v5(HopperV5(), "");
  const Hopper target(CustomHopperTarget(), ""), source(CustomHopperSource(), "");
  EXPECT_EQ(v4.fingerprint(), v5.fingerprint());
  EXPECT_NE(v5.fingerprint(), target.fingerprint());
  EXPECT_NE(target.fingerprint(), source.fingerprint());
}

TEST(Hopper, StartsWithinFiveThousandthsOfRest) {
  Hopper hopper(HopperV5(), "");
  Random random(3);
  std::array<double, 12> lowest{}, highest{};
  for (int episode = 0; episode < 200; ++episode) {
    hopper.Reset(&random);
    for (size_t i = 0; i < 12; ++i) {
      const double offset =
          i < 6 ? hopper.data().qpos[i] - hopper.model().qpos0[i] : hopper.data().qvel[i - 6];
      lowest[i] = std::min(lowest[i], offset);
      highest[i] = std::max(highest[i], offset);
    }
  }
  for (size_t i = 0; i < 12; ++i) {
    EXPECT_GE(lowest[i], -0.005);
    EXPECT_LE(highest[i], 0.005);
    EXPECT_LT(lowest[i], -0.0045);
    EXPECT_GT(highest[i], 0.0045);
  }
}

// Leaning a little more than allowed, at rest.
World::Outcome StepFallen(const HopperVariant& variant) {
  Hopper hopper(variant, "");
  const std::array<double, 6> qpos{0, 1.25, 0.25, 0, 0, 0};
  hopper.ResetTo(qpos, std::array<double, 6>{});
  return hopper.Step(kNothing);
}

TEST(Hopper, OnlyV5WithholdsTheBonusOfTheStepThatEndsTheEpisode) {
  const World::Outcome v4 = StepFallen(HopperV4()), v5 = StepFallen(HopperV5());
  EXPECT_TRUE(v4.terminated);
  EXPECT_TRUE(v5.terminated);
  EXPECT_NEAR(v4.reward - v5.reward, 1, 1e-12);
  EXPECT_TRUE(StepFallen(CustomHopperTarget()).terminated);
  EXPECT_GT(StepFallen(CustomHopperTarget()).reward, 0.5);
}

TEST(Hopper, IsPaidForStandingAndForMovingForwardButNotForEffort) {
  const auto reward = [](double speed, double torque) {
    Hopper hopper(HopperV5(), "");
    const std::array<double, 6> qpos{0, 1.25, 0, 0, 0, 0}, qvel{speed, 0, 0, 0, 0, 0};
    hopper.ResetTo(qpos, qvel);
    const World::Outcome outcome = hopper.Step(std::array<double, 3>{torque, 0, 0});
    EXPECT_FALSE(outcome.terminated);
    return outcome.reward - (hopper.data().qpos[0] - 0) / 0.008;
  };
  EXPECT_NEAR(reward(0, 0), 1, 1e-12);
  EXPECT_NEAR(reward(0.5, 0), 1, 1e-12);
  EXPECT_NEAR(reward(0, 1), 1 - 1e-3, 1e-12);
}

TEST(Hopper, GymnasiumsObservationLimitsVelocitiesAndTheCustomOneDoesNot) {
  const std::array<double, 6> qpos{3, 1.25, 0, 0, 0, 0}, qvel{0, 0, 0, 12, -40, 5};
  for (const bool clips : {true, false}) {
    Hopper hopper(clips ? HopperV4() : CustomHopperSource(), "");
    hopper.ResetTo(qpos, qvel);
    std::array<double, 11> observation{};
    hopper.Observe(observation, {}, {});
    EXPECT_EQ(observation[0], 1.25);  // x is left out
    EXPECT_EQ(observation[8], clips ? 10 : 12);
    EXPECT_EQ(observation[9], clips ? -10 : -40);
    EXPECT_EQ(observation[10], 5);
  }
}

TEST(Hopper, TheFirstCameraFollows) {
  const auto world = MakeWorld("Hopper-v5", {});
  EXPECT_EQ(world->cameras().front().name, "track");
  EXPECT_EQ(world->cameras().front().model_camera, 0);
  EXPECT_EQ(FindCamera(*world, "free").model_camera, -1);
}

TEST(Hopper, RefusesAnotherRobotsModel) {
  try {
    Hopper hopper(HopperV5(), SourcePath("tests/actor/worlds/other_reach.xml"));
    FAIL() << "took a Fetch arm for a hopper";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("expected 6, 6 and 3"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace shoal::worlds
