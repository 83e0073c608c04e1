#include "launch/watch/progress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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
  f.last_evaluation = EvaluationPoint{.env_steps = 2500, .success = 0.4, .mean_return = -3.25};
  return f;
}

TEST(FormatDuration, ShowsHoursOnlyWhenThereAreSome) {
  EXPECT_EQ(FormatDuration(65), "01:05");
  EXPECT_EQ(FormatDuration(3723.9), "1:02:03");
  EXPECT_EQ(FormatDuration(std::nullopt), "-");
}

TEST(SecondsLeft, IsTheRestOfTheBudgetAtThePresentRate) {
  ProgressFigures f = Sample();
  EXPECT_EQ(SecondsLeft(f), 100);
  f.env_steps = 20000;
  EXPECT_EQ(SecondsLeft(f), 0);
  f.env_steps_per_second = 0;
  EXPECT_EQ(SecondsLeft(f), std::nullopt);
}

TEST(FormatProgressLine, HoldsEveryFigureAndADashForMissingOnes) {
  EXPECT_THAT(FormatProgressLine(Sample()),
              AllOf(HasSubstr("01:05 running"), HasSubstr("2500/10000 env steps, 75/s"),
                    HasSubstr("1200 updates, 33.3/s"), HasSubstr("eval 40 %"),
                    HasSubstr("| critic_loss 0.125 actor_loss -2 |"), HasSubstr("lag 21"),
                    HasSubstr("left 01:40")));
  EXPECT_THAT(FormatProgressLine(ProgressFigures()),
              AllOf(HasSubstr("-/s"), HasSubstr("no update yet"), HasSubstr("lag -")));
}

TEST(FormatProgressLine, ShowsTheReturnWhereThereIsNoSuccess) {
  ProgressFigures f = Sample();
  f.last_evaluation->success.reset();
  f.last_evaluation->mean_return = 312.5;
  EXPECT_THAT(FormatProgressLine(f), HasSubstr("eval return 312.50"));
  EXPECT_THAT(FormatProgressBlock(f, 100)[4], HasSubstr("last eval  return 312.500 at 2500"));
}

TEST(FormatProgressLine, SaysWhoWaitsForWhom) {
  ProgressFigures f = Sample();
  EXPECT_THAT(FormatProgressLine(f), Not(HasSubstr("wait")));
  f.actors_wait = 0.01;
  f.learner_waits = 0.02;
  EXPECT_THAT(FormatProgressLine(f), HasSubstr("nobody waits"));
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

TEST(FormatProgressBlock, ShowsTheLastEvaluation) {
  std::string text;
  for (const std::string& line : FormatProgressBlock(Sample(), 100)) text += line + "\n";
  EXPECT_THAT(text, AllOf(HasSubstr("success 40.0 %, return -3.250 at 2500 env steps"),
                          HasSubstr("[#####...............]"), HasSubstr("none yet")));
}

}  // namespace
}  // namespace shoal::launch
