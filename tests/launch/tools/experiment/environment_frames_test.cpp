// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/environment_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/error_message.h"

namespace shoal::launch {
namespace {

std::vector<EvaluationFigures> CurveAt(const std::vector<uint64_t>& env_steps) {
  std::vector<EvaluationFigures> curve;
  for (const uint64_t steps : env_steps) {
    const auto updates = static_cast<uint64_t>(curve.size());
    curve.push_back({.env_steps = steps,
                     .episodes = 10 + updates,
                     .return_mean = static_cast<double>(steps) / 10});
  }
  return curve;
}

TEST(ActionRepeatOf, IsTheKeysOrTheTasksOwn) {
  Config config;
  config.task = "cartpole_swingup";
  EXPECT_EQ(ActionRepeatOf(config), 8);
  config.action_repeat = 3;
  EXPECT_EQ(ActionRepeatOf(config), 3);
  config.task = "walker_walk";
  config.action_repeat = 0;
  EXPECT_EQ(ActionRepeatOf(config), 2);
  config.task = "no_such_task";
  EXPECT_THAT(UsageMessage([&] { ActionRepeatOf(config); }), testing::HasSubstr("no_such_task"));
}

// The task of such an environment is not in the registry of this process.
TEST(ActionRepeatOf, IsOneForAnEnvironmentOfPython) {
  Config config;
  config.env.id = "Pendulum-v1";
  config.task = "Pendulum-v1";
  EXPECT_EQ(ActionRepeatOf(config), 1);
  config.action_repeat = 4;
  EXPECT_EQ(ActionRepeatOf(config), 4);
}

TEST(FindReturnAt, TakesTheNearestEvaluation) {
  const auto found = FindReturnAt(100'000, CurveAt({24'900, 25'002, 25'200}), 4);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->frames, 100'000);
  EXPECT_EQ(found->env_steps, 25'002u);
  EXPECT_EQ(found->episodes, 11u);
  EXPECT_EQ(found->return_mean, 2500.2);
}

TEST(FindReturnAt, IsEmptyBeyondTwoPercent) {
  EXPECT_TRUE(FindReturnAt(100'000, CurveAt({98'000}), 1)) << "exactly 2 % before";
  EXPECT_TRUE(FindReturnAt(100'000, CurveAt({51'000}), 2)) << "exactly 2 % after";
  EXPECT_FALSE(FindReturnAt(100'000, CurveAt({97'999, 102'001}), 1));
  EXPECT_FALSE(FindReturnAt(100'000, {}, 1));
}

// A run ends with an evaluation at the env steps of the last regular one, after further updates.
TEST(FindReturnAt, TakesTheLaterOfTwoThatAreEquallyNear) {
  EXPECT_EQ(FindReturnAt(100, CurveAt({100, 100}), 1)->episodes, 11u);
  EXPECT_EQ(FindReturnAt(100, CurveAt({99, 101}), 1)->env_steps, 101u);
}

}  // namespace
}  // namespace shoal::launch
