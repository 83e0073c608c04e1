// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/fetch_reach.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/actor/worlds/engine_warnings.h"

namespace shoal::worlds {
namespace {

struct Blocks {
  std::array<double, 10> observation{};
  std::array<double, 3> achieved{}, desired{};
};

Blocks Observe(const World& world) {
  Blocks blocks;
  world.Observe(blocks.observation, blocks.achieved, blocks.desired);
  return blocks;
}

// Everything an episode shows: every number of every observation.
std::vector<double> Episode(World* world, uint64_t key, int steps) {
  Random random(key);
  world->Reset(&random);
  std::vector<double> seen;
  for (int step = 0; step <= steps; ++step) {
    const Blocks blocks = Observe(*world);
    seen.insert(seen.end(), blocks.observation.begin(), blocks.observation.end());
    seen.insert(seen.end(), blocks.desired.begin(), blocks.desired.end());
    std::array<double, 4> action{};
    for (double& component : action) component = random.Uniform(-1, 1);
    if (step < steps) world->Step(action);
  }
  return seen;
}

TEST(FetchReach, GoalsFillTheCubeAroundTheStartAndNothingElse) {
  FetchReach world;
  const auto& centre = world.arm().initial_grip();
  constexpr int kDraws = 500;
  std::array<double, 3> low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9}, sum{};
  Random random(7);
  for (int i = 0; i < kDraws; ++i) {
    world.Reset(&random);
    const Blocks blocks = Observe(world);
    for (size_t axis = 0; axis < 3; ++axis) {
      const double offset = blocks.desired[axis] - centre[axis];
      low[axis] = std::min(low[axis], offset);
      high[axis] = std::max(high[axis], offset);
      sum[axis] += offset;
    }
  }
  // Mean of n uniforms over a width of 0.3: sigma = 0.3 / sqrt(12 n).
  const double sigma = 0.3 / std::sqrt(12.0 * kDraws);
  for (size_t axis = 0; axis < 3; ++axis) {
    EXPECT_GE(low[axis], -0.15) << axis;
    EXPECT_LE(high[axis], 0.15) << axis;
    EXPECT_LT(low[axis], -0.145) << axis;
    EXPECT_GT(high[axis], 0.145) << axis;
    EXPECT_NEAR(sum[axis] / kDraws, 0, 5 * sigma) << axis;
  }
}

TEST(FetchReach, TheGoalTakesThreeDrawsInTheOrderXYZ) {
  FetchReach world;
  Random random(11), same(11);
  world.Reset(&random);
  const Blocks blocks = Observe(world);
  for (size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(blocks.desired[axis], world.arm().initial_grip()[axis] + same.Uniform(-0.15, 0.15));
  }
  EXPECT_EQ(random.state(), same.state());
}

TEST(FetchReach, AnEpisodeDoesNotDependOnTheOnesBefore) {
  FetchReach fresh, used;
  Episode(&used, 1, 20);
  Episode(&used, 2, 3);
  EXPECT_EQ(Episode(&fresh, 3, 20), Episode(&used, 3, 20));
  EXPECT_NE(Episode(&fresh, 4, 20), Episode(&fresh, 3, 20));
}

TEST(FetchReach, InterleavedWorldsDoNotTouchEachOther) {
  FetchReach alone, left, right;
  const std::vector<double> expected = Episode(&alone, 5, 10);
  Random random(5), other(6);
  left.Reset(&random);
  std::vector<double> seen;
  for (int step = 0; step <= 10; ++step) {
    right.Reset(&other);
    right.Step(std::array<double, 4>{1, -1, 1, 0});
    const Blocks blocks = Observe(left);
    seen.insert(seen.end(), blocks.observation.begin(), blocks.observation.end());
    seen.insert(seen.end(), blocks.desired.begin(), blocks.desired.end());
    std::array<double, 4> action{};
    for (double& component : action) component = random.Uniform(-1, 1);
    if (step < 10) left.Step(action);
  }
  EXPECT_EQ(seen, expected);
}

TEST(FetchReach, TheTargetsMarkerSitsAtTheGoal) {
  FetchReach world;
  const std::array<double, 3> goal{1.25, 0.85, 0.61};
  world.ResetTo(goal);
  const double* marker = world.data().site_xpos + 3 * world.SiteId("target0");
  for (size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(marker[axis], goal[axis], 1e-12) << axis;
  world.Step(std::array<double, 4>{1, 0, 0, 0});
  for (size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(marker[axis], goal[axis], 1e-12) << axis;
}

TEST(FetchReach, TheAchievedGoalIsTheGrip) {
  FetchReach world;
  world.ResetTo({1.25, 0.85, 0.61});
  world.Step(std::array<double, 4>{0.2, -0.4, 0.6, 0});
  const Blocks blocks = Observe(world);
  for (size_t axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(blocks.achieved[axis], blocks.observation[axis]);
  }
}

TEST(FetchReach, TheCrossStandsAtTheWorldsOriginRightAfterAReset) {
  FetchReach world;
  world.ResetTo({1.25, 0.85, 0.61});
  const double* cross = world.data().xpos + 3 * world.BodyId("robot0:mocap");
  EXPECT_EQ(std::vector<double>(cross, cross + 3), (std::vector<double>{0, 0, 0}));
  world.Step(std::array<double, 4>{0, 0, 0, 0});
  EXPECT_GT(cross[0], 1);
}

TEST(FetchReach, RunsWithoutEngineWarnings) {
  ExpectEngineWarnings(0);
  FetchReach world;
  Episode(&world, 8, 50);
}

}  // namespace
}  // namespace shoal::worlds
