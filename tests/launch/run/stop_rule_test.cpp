// SPDX-License-Identifier: Apache-2.0
#include "launch/run/stop_rule.h"

#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

Config Rule(double success, int evaluations) {
  Config config;
  config.stop = {.success = success, .evaluations = evaluations};
  config.env_steps = 1000;
  return config;
}

void Feed(StopRule& rule, std::initializer_list<double> successes) {
  uint64_t steps = 0;
  for (double success : successes) {
    rule.OnEvaluation(
        {.env_steps = steps += 100, .updates = steps / 2, .success = success, .episodes = 100});
  }
}

TEST(StopRule, PoolsTheNewestEvaluations) {
  StopRule rule(Rule(0.9, 2));
  Feed(rule, {1});
  EXPECT_FALSE(rule.TargetReached());  // one is not two
  Feed(rule, {0.79, 0.99});            // 178 of 200
  EXPECT_FALSE(rule.TargetReached());
  EXPECT_FALSE(rule.first_success().has_value());
  Feed(rule, {0.81});  // 180 of 200
  EXPECT_TRUE(rule.TargetReached());
  Feed(rule, {0.98});  // 179 of 200: the newest count
  EXPECT_FALSE(rule.TargetReached());
}

TEST(StopRule, WeighsEvaluationsByTheirEpisodes) {
  StopRule rule(Rule(0.9, 2));
  rule.OnEvaluation({.success = 1, .episodes = 10});
  rule.OnEvaluation({.success = 0.88, .episodes = 100});
  EXPECT_FALSE(rule.TargetReached());  // 98 of 110
  rule.OnEvaluation({.success = 0.92, .episodes = 100});
  EXPECT_TRUE(rule.TargetReached());  // 180 of 200
}

TEST(StopRule, FirstSuccessIsTheStartOfTheFirstThatReachIt) {
  StopRule rule(Rule(0.9, 2));
  Feed(rule, {0.95, 0.5, 0.92, 0.93, 0.94, 0.1, 1, 1});
  ASSERT_TRUE(rule.first_success().has_value());
  EXPECT_EQ(rule.first_success()->env_steps, 300u);
  EXPECT_EQ(rule.first_success()->updates, 150u);
}

TEST(StopRule, AboveOneNeverStopsButMeasuresTheUsualTarget) {
  StopRule rule(Rule(2, 2));
  Feed(rule, {0.98, 1});
  EXPECT_FALSE(rule.TargetReached());
  EXPECT_EQ(rule.target(), 0.98);
  ASSERT_TRUE(rule.first_success().has_value());
  EXPECT_EQ(rule.first_success()->env_steps, 100u);
}

TEST(StopRule, AChangeJudgesFormerEvaluationsAnew) {
  StopRule rule(Rule(0.9, 2));
  Feed(rule, {0.5, 0.8, 0.85});
  EXPECT_FALSE(rule.TargetReached());
  Config config = Rule(0.8, 2);
  config.env_steps = 500;
  rule.Change(config);
  EXPECT_TRUE(rule.TargetReached());
  EXPECT_EQ(rule.target(), 0.8);
  ASSERT_TRUE(rule.first_success().has_value());
  EXPECT_EQ(rule.first_success()->env_steps, 200u);
  EXPECT_TRUE(rule.BudgetSpent(500));
  rule.Change(Rule(0.8, 3));
  EXPECT_FALSE(rule.TargetReached());
  EXPECT_FALSE(rule.first_success().has_value());
}

TEST(StopRule, BudgetIsSpentAtTheLastStep) {
  const StopRule rule(Rule(0.9, 2));
  EXPECT_FALSE(rule.BudgetSpent(999));
  EXPECT_TRUE(rule.BudgetSpent(1000));
}

TEST(StopRule, InLockstepTheBudgetsLastPhaseIsPlayedToItsEnd) {
  Config config = Rule(0.9, 2);
  config.lockstep = true;
  config.lockstep_steps = 8;
  config.envs_per_actor = 4;
  config.replay.min_size = 96;  // then phases of 32 env steps, up to 1024
  EXPECT_FALSE(StopRule(config).BudgetSpent(1000));
  EXPECT_TRUE(StopRule(config).BudgetSpent(1024));
}

TEST(StopRule, ATaskWithoutSuccessOnlyEndsByItsBudget) {
  StopRule rule(Rule(0, 1));  // a target that any success rate would reach
  for (uint64_t steps : {100u, 200u, 300u}) {
    rule.OnEvaluation({.env_steps = steps, .success = std::nullopt, .mean_return = 1000});
  }
  EXPECT_FALSE(rule.TargetReached());
  EXPECT_FALSE(rule.first_success().has_value());
  EXPECT_TRUE(rule.BudgetSpent(1000));
}

TEST(FormatScore, LeavesOutASuccessThatIsNotThere) {
  EXPECT_EQ(FormatScore({.success = 0.98, .mean_return = -0.97}), "success 98.0 %, return -0.970");
  EXPECT_EQ(FormatScore({.success = std::nullopt, .mean_return = 312.5}), "return 312.500");
}

TEST(FormatWholeScore, HasLengthAndDistanceOfATaskWithSuccess) {
  EXPECT_EQ(FormatWholeScore({.success = 0.98,
                              .mean_return = -0.97,
                              .mean_length = 48.5,
                              .final_distance = 0.0214,
                              .episodes = 50}),
            "success 98.0 % of 50 episodes, return -0.970, length 48.5, final distance 0.021 m");
  EXPECT_EQ(
      FormatWholeScore(
          {.success = std::nullopt, .mean_return = 312.5, .mean_length = 740.2, .episodes = 20}),
      "return 312.500, length 740.2, 20 episodes");
}

TEST(FormatScore, SaysHowManyEpisodesWereFaulty) {
  EXPECT_EQ(FormatScore({.success = 0.5, .mean_return = -1, .episodes = 50, .faulty_episodes = 2}),
            "success 50.0 % of 50 episodes, return -1.000, 2 faulty episodes");
  EXPECT_EQ(FormatScore({.success = std::nullopt, .mean_return = 1, .faulty_episodes = 2}),
            "return 1.000, 2 faulty episodes");
}

TEST(FormatScore, SaysHowSureItIs) {
  EXPECT_EQ(
      FormatScore({.success = 0.98, .mean_return = -0.97, .return_std = 0.12, .episodes = 50}),
      "success 98.0 % of 50 episodes, return -0.970 +- 0.120");
  EXPECT_EQ(FormatScore({.success = std::nullopt,
                         .mean_return = 312.5,
                         .return_std = 8.1,
                         .mean_length = 740.2,
                         .episodes = 20}),
            "return 312.500 +- 8.100, length 740.2, 20 episodes");
}

}  // namespace
}  // namespace shoal::launch
