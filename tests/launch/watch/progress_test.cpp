// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace shoal::launch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

ProgressFigures Sample() {
  ProgressFigures f;
  f.run = "reach-s1";
  f.state = "running";
  f.elapsed_seconds = 65;
  f.env_steps = 2500;
  f.budget = 10000;
  f.env_steps_per_second = 75;
  f.updates = 1200;
  f.updates_per_second = 33.3;
  f.update_figures = {{"critic_loss", 0.125}, {"actor_loss", -2}};
  f.policy_lag = 21;
  f.seconds_left = 100;
  f.rollout_success = 0.3;
  f.rollout_return = -4.5;
  f.rollout_length = 50;
  f.last_evaluation = EvaluationPoint{
      .env_steps = 2500, .success = 0.4, .mean_return = -3.25, .return_std = 1.5, .episodes = 20};
  return f;
}

TEST(FormatDuration, ShowsHoursOnlyWhenThereAreSome) {
  EXPECT_EQ(FormatDuration(65), "01:05");
  EXPECT_EQ(FormatDuration(3723.9), "1:02:03");
  EXPECT_EQ(FormatDuration(std::nullopt), "-");
}

TEST(FormatProgressLine, HoldsEveryFigureAndADashForMissingOnes) {
  EXPECT_THAT(FormatProgressLine(Sample()),
              AllOf(HasSubstr("01:05 running"), HasSubstr("2500/10000 env steps, 75/s"),
                    HasSubstr("1200 updates, 33.3/s"), HasSubstr("eval 40 % | actors 30 % |"),
                    HasSubstr("| critic_loss 0.125 actor_loss -2 |"), HasSubstr("lag 21"),
                    HasSubstr("left 01:40")));
  EXPECT_THAT(FormatProgressLine(ProgressFigures()),
              AllOf(HasSubstr("-/s"), HasSubstr("no update yet"), HasSubstr("lag -")));
}

TEST(FormatProgressLine, EndsWithTheActorsThatDoNotWork) {
  ProgressFigures f = Sample();
  f.trouble = "actors 1 of 2: actor-1: exit code 1";
  EXPECT_THAT(FormatProgressLine(f), ::testing::EndsWith("left 01:40 | " + f.trouble));
  EXPECT_THAT(FormatProgressBlock(f, 100),
              ::testing::Contains("  trouble    actors 1 of 2: actor-1: exit code 1"));
  EXPECT_THAT(FormatProgressBlock(Sample(), 100), ::testing::Each(Not(HasSubstr("trouble"))));
}

TEST(FormatProgressLine, ShowsFaultyEpisodesWhereThereAreSome) {
  ProgressFigures f = Sample();
  EXPECT_THAT(FormatProgressLine(f), testing::Not(HasSubstr("faulty")));
  f.faulty_episodes = 3;
  EXPECT_THAT(FormatProgressLine(f), HasSubstr("| 3 faulty episodes | left"));
  const std::vector<std::string> block = FormatProgressBlock(f, 200);
  EXPECT_TRUE(std::ranges::any_of(block, [](const std::string& line) {
    return line.starts_with("  actors") && line.ends_with("; 3 faulty episodes");
  }));
}

TEST(FormatProgressLine, ShowsTheReturnWhereThereIsNoSuccess) {
  ProgressFigures f = Sample();
  f.last_evaluation->success.reset();
  f.last_evaluation->mean_return = 312.5;
  f.last_evaluation->return_std = 8;
  f.last_evaluation->mean_length = 740.25;
  f.rollout_success.reset();
  f.rollout_return = 290;
  f.rollout_length = 700;
  EXPECT_THAT(FormatProgressLine(f),
              HasSubstr("eval return 312.50 length 740 | actors return 290.00 length 700 |"));
  const std::vector<std::string> block = FormatProgressBlock(f, 100);
  EXPECT_EQ(block[4], "  last eval  at 2500: return 312.500 +- 8.000, length 740.2, 20 episodes");
  EXPECT_EQ(block[6], "  actors     return 290.000, length 700; their last 100 episodes");
}

TEST(FormatProgressLine, ARunPastItsBudgetSaysSo) {
  ProgressFigures f = Sample();
  f.budget = 100;
  EXPECT_THAT(FormatProgressLine(f), HasSubstr("| 2500 env steps (budget 100), 75/s |"));
  EXPECT_THAT(FormatProgressBlock(f, 100)[2],
              HasSubstr("2500 of 100  100 %  [####################]"));
}

TEST(FormatProgressLine, SaysWhoWaitsForWhom) {
  ProgressFigures f = Sample();
  EXPECT_THAT(FormatProgressLine(f), Not(HasSubstr("wait")));
  f.actors_wait = 0.01;
  f.learner_waits = 0.02;
  EXPECT_THAT(FormatProgressLine(f), HasSubstr("neither side waits"));
  f.learner_waits = 0.5;
  EXPECT_THAT(FormatProgressLine(f), HasSubstr("learner waits for the actors 50 %"));
  f.actors_wait = 0.3;
  EXPECT_THAT(FormatProgressLine(f), HasSubstr("actors wait for the learner 30 %"));
}

TEST(FormatProgressBlock, NeverExceedsTheWidth) {
  for (int width : {10, 40, 80}) {
    for (const std::string& line : FormatProgressBlock(Sample(), width)) {
      EXPECT_LE(line.size(), static_cast<size_t>(width));
    }
  }
}

TEST(FormatProgressBlock, EvaluationsAndActorsFitOnOrdinaryTerminals) {
  ProgressFigures f = Sample();
  f.last_evaluation->env_steps = 123456;
  f.last_evaluation->success = 1;
  f.last_evaluation->episodes = 100;
  const std::vector<std::string> narrow = FormatProgressBlock(f, 79),
                                 wide = FormatProgressBlock(f, 200);
  EXPECT_EQ(narrow[4], wide[4]);
  EXPECT_EQ(narrow[6], wide[6]);
}

TEST(FormatProgressBlock, ShowsTheLastEvaluation) {
  std::string text;
  for (const std::string& line : FormatProgressBlock(Sample(), 100)) text += line + "\n";
  EXPECT_THAT(text,
              AllOf(HasSubstr("at 2500: success 40.0 % of 20 episodes, return -3.250 +- 1.500\n"),
                    HasSubstr("[#####...............]"), HasSubstr("none yet")));
}

}  // namespace
}  // namespace shoal::launch
