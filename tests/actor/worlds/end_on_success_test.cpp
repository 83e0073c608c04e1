// SPDX-License-Identifier: Apache-2.0
// end_on_success: episodes that end with the step that reaches the goal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "tests/actor/worlds/played_environment.h"
#include "tests/support/error_message.h"

namespace shoal::worlds {
namespace {

TEST(EndOnSuccess, AnEpisodeEndsOnSuccessWhereItIsAsked) {
  Config config = StateOnly("FetchReach");
  config.distance_threshold = 1000;  // every step succeeds
  Player goes_on(Make(config));
  goes_on.Reset(3);
  for (int i = 1; i <= 50; ++i) {
    const StepResult result = goes_on.Step();
    EXPECT_TRUE(result.success);
    EXPECT_FALSE(result.terminated);
    EXPECT_EQ(result.truncated, i == 50);
  }
  config.end_on_success = true;
  Player ends(Make(config));
  ends.Reset(3);
  const StepResult first = ends.Step();
  EXPECT_TRUE(first.success);
  EXPECT_TRUE(first.terminated);
  EXPECT_FALSE(first.truncated);
  config.action_repeat = 3;  // of which the first control step ends it
  Player repeats(Make(config));
  repeats.Reset(3);
  EXPECT_TRUE(repeats.Step().terminated);
  EXPECT_EQ(repeats.vector, ends.vector);
}

// The goal is approached slowly, so that some episodes first reach it with their last step.
TEST(EndOnSuccess, ASuccessInTheLastStepIsNoTimeLimit) {
  const std::array<float, 4> action{0.05f, 0, 0, 0};
  Config config = StateOnly("FetchReach");
  const auto distances = [&](uint64_t key) {
    Player player(Make(config));
    player.Reset(key);
    std::array<float, 50> all{};
    for (float& distance : all) {
      distance = player.environment->Step(action, {{}, player.vector}).distance;
    }
    return all;
  };
  uint64_t key = 0;
  float last = 1, nearest = 0;
  while (last >= nearest && key < 50) {
    const auto all = distances(++key);
    last = all.back();
    nearest = *std::min_element(all.begin(), all.end() - 1);
  }
  ASSERT_LT(last, nearest);
  config.distance_threshold = (double{last} + double{nearest}) / 2;
  config.end_on_success = true;
  Player player(Make(config));
  player.Reset(key);
  StepResult result;
  for (int i = 1; i <= 50; ++i) {
    EXPECT_FALSE(result.terminated) << i;
    result = player.environment->Step(action, {{}, player.vector});
  }
  EXPECT_TRUE(result.terminated);
  EXPECT_FALSE(result.truncated);
}

TEST(EndOnSuccess, WithoutSuccessAnEpisodeHasItsWholeLength) {
  Config config = StateOnly("FetchReach");
  config.distance_threshold = 1e-9;
  config.end_on_success = true;
  Player player(Make(config));
  player.Reset(3);
  for (int i = 1; i <= 50; ++i) {
    const StepResult result = player.Step();
    EXPECT_FALSE(result.terminated);
    EXPECT_EQ(result.truncated, i == 50);
  }
}

TEST(EndOnSuccess, ASuccessThatATaskDoesNotHaveEndsNoEpisode) {
  Config config = StateOnly("Hopper-v4");
  config.observation.goal_mode = "none";
  config.end_on_success = true;
  EXPECT_THAT(UsageMessage([&] { Make(config); }),
              testing::HasSubstr("end_on_success is true, but task Hopper-v4 has no goals"));
}

}  // namespace
}  // namespace shoal::worlds
