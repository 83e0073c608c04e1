// SPDX-License-Identifier: Apache-2.0
#include "common/tasks/fetch_tasks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "common/base/random.h"
#include "common/tasks/task_registry.h"

namespace shoal::tasks {
namespace {

using Names = std::vector<std::string>;

constexpr const char* kWorlds[] = {"FetchReach", "FetchPush", "FetchSlide", "FetchPickAndPlace"};

Names NamesOf(const Block& block) {
  Names names;
  for (const Component& component : block.components) names.push_back(component.name);
  return names;
}

TEST(FetchTasks, EveryTaskHasASparseAndADenseReward) {
  Names expected;
  for (const std::string world : kWorlds) {
    expected.push_back(world);
    expected.push_back(world + "Dense");
  }
  Names names;
  for (const Task& task : FetchTasks()) {
    names.push_back(task.name());
    const bool dense = task.name() == task.world() + "Dense";
    EXPECT_EQ(task.reward_kind(), dense ? RewardKind::kDense : RewardKind::kSparse);
  }
  EXPECT_EQ(names, expected);
}

TEST(FetchTasks, AllEndAfterFiftyStepsAndReachWithinFiveCentimetres) {
  for (const Task& task : FetchTasks()) {
    EXPECT_EQ(task.episode_length(), 50) << task.name();
    EXPECT_EQ(task.action_size(), 4) << task.name();
    EXPECT_EQ(task.goal_size(), 3) << task.name();
    EXPECT_EQ(task.distance_threshold(), 0.05) << task.name();
  }
}

TEST(FetchTasks, AnObjectsNumbersComeInThePublishedOrder) {
  const Names expected{"grip_x",
                       "grip_y",
                       "grip_z",
                       "object_x",
                       "object_y",
                       "object_z",
                       "object_from_grip_x",
                       "object_from_grip_y",
                       "object_from_grip_z",
                       "right_finger",
                       "left_finger",
                       "object_angle_x",
                       "object_angle_y",
                       "object_angle_z",
                       "object_velocity_from_grip_x",
                       "object_velocity_from_grip_y",
                       "object_velocity_from_grip_z",
                       "object_angular_velocity_x",
                       "object_angular_velocity_y",
                       "object_angular_velocity_z",
                       "grip_velocity_x",
                       "grip_velocity_y",
                       "grip_velocity_z",
                       "right_finger_velocity",
                       "left_finger_velocity"};
  for (const char* name : {"FetchPush", "FetchSlide", "FetchPickAndPlaceDense"}) {
    const Block& observation = FindTask(name).observation();
    EXPECT_EQ(NamesOf(observation), expected) << name;
    EXPECT_EQ(observation.components[3].unit, "m");
    EXPECT_EQ(observation.components[12].unit, "rad");
    EXPECT_EQ(observation.components[14].unit, "m/step");
    EXPECT_EQ(observation.components[19].unit, "rad/step");
  }
  EXPECT_EQ(FindTask("FetchReach").observation().size(), 10);
}

TEST(FetchTasks, OnlyPickAndPlaceUsesItsFingers) {
  for (const Task& task : FetchTasks()) {
    const bool shut = task.action()[3].meaning.find("held shut") != std::string::npos;
    EXPECT_EQ(shut, task.world() != "FetchPickAndPlace") << task.name();
  }
}

// Relabelling with other goals relies on this.
TEST(FetchTasks, RewardsOfABatchOfArbitraryGoalsFollowTheirDistances) {
  constexpr size_t kGoals = 200;
  Random random(3);
  std::vector<float> achieved(3 * kGoals), desired(3 * kGoals), reward(kGoals);
  for (float& x : achieved) x = static_cast<float>(random.Uniform(0, 0.1));
  for (float& x : desired) x = static_cast<float>(random.Uniform(0, 0.1));
  for (const Task& task : FetchTasks()) {
    task.ComputeRewards(achieved, desired, reward);
    int near = 0;
    for (size_t i = 0; i < kGoals; ++i) {
      double sum = 0;
      for (size_t axis = 3 * i; axis < 3 * i + 3; ++axis) {
        sum += (double{achieved[axis]} - desired[axis]) * (double{achieved[axis]} - desired[axis]);
      }
      const double distance = std::sqrt(sum);
      near += distance <= 0.05;
      const double expected = task.reward_kind() == RewardKind::kDense ? -distance
                              : distance > 0.05                        ? -1.0
                                                                       : 0.0;
      EXPECT_FLOAT_EQ(reward[i], static_cast<float>(expected)) << task.name() << " " << i;
    }
    EXPECT_GT(near, 20);
    EXPECT_LT(near, 180);
  }
}

}  // namespace
}  // namespace shoal::tasks
