// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/recent_run.h"

#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

RunTotals LearnerTotals(double busy, double backward) {
  RunTotals totals;
  totals["learner"] = {.processes = 1, .seconds = busy, .stages = {{"backward", backward}}};
  return totals;
}

TEST(RecentRun, TotalsAreThoseOfTheLastHalfMinute) {
  RecentRun run;
  // A hundred seconds without an update, then half of the time in one stage.
  for (int second = 0; second <= 140; ++second) {
    run.Add({.seconds = double(second), .env_steps = 0, .updates = {}},
            LearnerTotals(second, std::max(0, second - 100) / 2.0));
  }
  const RunTotals totals = run.Totals();
  EXPECT_NEAR(totals.at("learner").seconds, 30, 1);
  EXPECT_NEAR(totals.at("learner").stages.at("backward") / totals.at("learner").seconds, 0.5, 0.01);
}

TEST(RecentRun, RolesThatHaveNotRunMeanwhileAreAbsent) {
  RunTotals before = LearnerTotals(10, 5);
  before["eval"] = {.processes = 1, .seconds = 3};
  RunTotals now = LearnerTotals(12, 6);
  now["eval"] = before["eval"];
  const RunTotals grown = Since(before, now);
  EXPECT_EQ(grown.size(), 1u);
  EXPECT_EQ(grown.at("learner").seconds, 2);
  EXPECT_EQ(grown.at("learner").stages.at("backward"), 1);
}

// An ordinary run: quick while the replay is filled, then bounded by the learner,
// with records stored in chunks and a pause at each checkpoint.
TEST(RecentRun, TheTimeLeftOfASteadyRunNeverJumps) {
  constexpr double kBudget = 80000;
  RecentRun run;
  double steps = 0, updates = 0;
  std::optional<double> before;
  int told = 0;
  for (int second = 0; steps < kBudget; ++second) {
    const bool filling = steps < 20000;
    const bool pauses = second % 17 == 0;
    if (filling) steps += 1000;
    if (!filling && !pauses && second % 3 == 0) steps += 300;
    if (!filling) updates += 100;
    run.Add({.seconds = double(second), .env_steps = steps, .updates = updates}, {});
    const auto left = run.SecondsLeft(steps, kBudget);
    if (filling) {
      EXPECT_FALSE(left) << "what comes is many times slower";
    }
    if (left && before && steps < kBudget) {
      EXPECT_LT(*left, 1.3 * *before) << second;
      EXPECT_GT(*left + 5, *before / 1.3) << second;
    }
    told += left.has_value();
    before = left;
  }
  EXPECT_GT(told, 500);
  EXPECT_EQ(run.SecondsLeft(steps, kBudget), 0);
}

TEST(RecentRun, BeginsAnewAfterAPause) {
  RecentRun run;
  for (int second = 0; second <= 20; ++second) {
    run.Add({.seconds = double(second), .env_steps = 10.0 * second, .updates = second}, {});
  }
  ASSERT_EQ(run.env_steps_per_second(), 10);
  ASSERT_TRUE(run.SecondsLeft(200, 400));
  run.Forget(20);
  EXPECT_FALSE(run.env_steps_per_second());
  EXPECT_FALSE(run.SecondsLeft(200, 400));
  run.Add({.seconds = 21, .env_steps = 210, .updates = 21}, LearnerTotals(600, 0));
  EXPECT_TRUE(run.Totals().empty()) << "a report that spans the pause";
  run.Add({.seconds = 24, .env_steps = 240, .updates = 24}, LearnerTotals(603, 1));
  run.Add({.seconds = 28, .env_steps = 280, .updates = 28}, LearnerTotals(607, 3));
  EXPECT_EQ(run.env_steps_per_second(), 10);
  EXPECT_EQ(run.Totals().at("learner").seconds, 4);
}

}  // namespace
}  // namespace shoal::launch
