// SPDX-License-Identifier: Apache-2.0
#include "common/tasks/task.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "common/base/error.h"
#include "common/tasks/task_registry.h"

namespace shoal::tasks {
namespace {

// Distances 0, 0.03 and 5 (a 3-4-5 triangle).
const std::vector<float> kAchieved{1, 2, 3, 0, 0, 0, 3, 4, 0};
const std::vector<float> kDesired{1, 2, 3, 0, 0.03f, 0, 0, 0, 0};

TEST(Task, DenseRewardIsMinusTheDistance) {
  std::array<float, 3> reward{};
  FindTask("FetchReachDense").ComputeRewards(kAchieved, kDesired, reward);
  EXPECT_EQ(reward[0], 0.0f);
  EXPECT_FLOAT_EQ(reward[1], -0.03f);
  EXPECT_EQ(reward[2], -5.0f);
}

TEST(Task, SparseRewardIsMinusOneBeyondTheThreshold) {
  std::array<float, 3> reward{};
  FindTask("FetchReach").ComputeRewards(kAchieved, kDesired, reward);
  EXPECT_EQ(reward, (std::array<float, 3>{0, 0, -1}));
}

TEST(Task, AtTheThresholdThereIsNeitherPenaltyNorSuccess) {
  const Task& task = FindTask("FetchReach");
  EXPECT_EQ(task.Reward(0.05), 0.0f);
  EXPECT_FALSE(task.Success(0.05));
  EXPECT_TRUE(task.Success(std::nextafter(0.05, 0.0)));
  EXPECT_EQ(task.Reward(std::nextafter(0.05, 1.0)), -1.0f);
}

TEST(Task, WithAnotherThresholdOnlySuccessAndSparseRewardChange) {
  const Task& task = FindTask("FetchReach");
  const Task wide = task.WithThreshold(0.2);
  EXPECT_EQ(wide.distance_threshold(), 0.2);
  EXPECT_EQ(task.distance_threshold(), 0.05);
  EXPECT_TRUE(wide.Success(0.1));
  EXPECT_EQ(wide.Reward(0.1), 0.0f);
  EXPECT_EQ(task.Reward(0.1), -1.0f);
  EXPECT_EQ(wide.name(), task.name());
}

TEST(Task, ATaskWithoutGoalsTakesNoThreshold) {
  Task::Description description;
  description.name = "Run";
  description.episode_length = 1;
  try {
    Task(description).WithThreshold(0.1);
    FAIL() << "a threshold for nothing";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_NE(std::string(error.what()).find("task Run has no goals"), std::string::npos);
  }
}

TEST(Task, ABatchEqualsItsRowsBitForBit) {
  const Task& task = FindTask("FetchReachDense");
  std::vector<float> achieved, desired;
  for (int i = 0; i < 300; ++i) {
    achieved.push_back(1.3f + 0.001f * static_cast<float>(i));
    desired.push_back(1.1f + 0.0007f * static_cast<float>((i * 7) % 300));
  }
  std::vector<float> batch(100), row(1);
  task.ComputeRewards(achieved, desired, batch);
  for (size_t i = 0; i < batch.size(); ++i) {
    task.ComputeRewards(std::span(achieved).subspan(3 * i, 3), std::span(desired).subspan(3 * i, 3),
                        row);
    EXPECT_EQ(batch[i], row[0]) << i;
  }
}

TEST(TaskDeathTest, ATaskWithoutGoalsHasNoDistanceAndNoGoalReward) {
  EXPECT_DEATH(FindTask("Hopper-v5").Distance({}, {}), "no goals");
  EXPECT_DEATH(FindTask("Hopper-v5").Reward(0), "no goals");
}

TEST(TaskDeathTest, RefusesGoalsOfAnotherSize) {
  std::array<float, 2> reward{};
  EXPECT_DEATH(FindTask("FetchReach").ComputeRewards(kAchieved, kDesired, reward), "CHECK|9 for 2");
}

}  // namespace
}  // namespace shoal::tasks
