// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/tools/reward_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/tasks/task_registry.h"

namespace shoal::worlds {
namespace {

// Two steps of one episode, by hand: 3-4-5 triangles of 0.05 m and 0.5 m.
std::vector<RewardSample> Samples(const tasks::Task& task) {
  std::vector<RewardSample> samples(2);
  samples[0].achieved = {0.03f, 0.04f, 0};
  samples[1].achieved = {0.3f, 0.4f, 0};
  for (RewardSample& sample : samples) {
    sample.desired = {0, 0, 0};
    const double distance = task.Distance(sample.achieved, sample.desired);
    sample.result.reward = task.Reward(distance);
    sample.result.success = task.Success(distance);
  }
  return samples;
}

TEST(RewardCheck, EveryRegisteredTaskPasses) {
  for (const std::string& name : tasks::TaskNames()) {
    const RewardCheck check = CheckRewards({.task = name, .env_steps = 60});
    EXPECT_TRUE(check.Passed()) << ToText(check);
    EXPECT_EQ(check.env_steps, 60);
    EXPECT_EQ(check.relabelled, tasks::FindTask(name).goal_size() > 0 ? 240 : 0) << name;
  }
}

TEST(RewardCheck, StepsOfTheFormulaPass) {
  for (const char* name : {"FetchReach", "FetchReachDense"}) {
    const tasks::Task& task = tasks::FindTask(name);
    const RewardCheck check = CompareRewards(task, Samples(task), /*relabels=*/5, /*seed=*/1);
    EXPECT_TRUE(check.Passed()) << ToText(check);
    EXPECT_EQ(check.episodes, 1);
    EXPECT_EQ(check.relabelled, 10);
  }
}

TEST(RewardCheck, AStepWithAnotherRewardOrSuccessIsCounted) {
  const tasks::Task& task = tasks::FindTask("FetchReachDense");
  std::vector<RewardSample> samples = Samples(task);
  samples[1].result.reward = std::nextafterf(samples[1].result.reward, 0);
  const RewardCheck reward = CompareRewards(task, samples, 1, 1);
  EXPECT_EQ(reward.step_computed, 1);
  EXPECT_EQ(reward.computed_formula, 0);
  EXPECT_FALSE(reward.Passed());
  EXPECT_THAT(ToText(reward), testing::HasSubstr("FAILED"));

  samples = Samples(task);
  samples[1].result.success = true;
  const RewardCheck success = CompareRewards(task, samples, 1, 1);
  EXPECT_EQ(success.success_formula, 1);
  EXPECT_FALSE(success.Passed());
}

TEST(RewardCheck, ReportsMismatchesByKind) {
  RewardCheck check;
  check.env_steps = 1;
  check.relabelled_formula = 3;
  const nlohmann::ordered_json json = ToJson(check);
  EXPECT_EQ(json.at("mismatches").at("relabelled_formula"), 3);
  EXPECT_EQ(json.at("mismatches").at("step_computed"), 0);
  EXPECT_EQ(json.at("passed"), false);
}

TEST(RewardCheck, AnUnknownTaskIsRefusedListingThoseThereAre) {
  try {
    CheckRewards({.task = "FetchSleep"});
    FAIL() << "checked a task that is not there";
  } catch (const Error& error) {
    EXPECT_EQ(error.exit_code(), 2);
    EXPECT_THAT(error.what(), testing::HasSubstr("FetchReachDense"));
  }
}

}  // namespace
}  // namespace shoal::worlds
