// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/metrics_view.h"

#include <gtest/gtest.h>

#include "tests/launch/watch/report_message.h"

namespace shoal::launch {
namespace {

using std::chrono::seconds;

const SteadyTime kNow = SteadyTime() + seconds(1000);

TEST(MetricsView, MissingFiguresAreEmpty) {
  MetricsView view;
  EXPECT_FALSE(view.Get({.role = "learner"}, "updates"));
  EXPECT_FALSE(view.Sum("actor", "env_steps", kNow));
  EXPECT_FALSE(view.Mean("actor", "rollout_success", "episodes", kNow));
  EXPECT_EQ(view.Total("actor", "resends"), 0);
}

TEST(MetricsView, KeepsTheLastReportThoughTheClockWasSetBack) {
  MetricsView view;
  view.OnMessage(Report("learner", 0, 7, 5000, {{"updates", 10}}), kNow);
  view.OnMessage(Report("learner", 0, 7, 1401, {{"updates", 20}}), kNow);
  EXPECT_EQ(view.Get({.role = "learner"}, "updates"), 20);
}

TEST(MetricsView, SumsAndWeighsFreshProcessesOnly) {
  MetricsView view;
  view.OnMessage(Report("actor", 0, 1, 1, {{"rate", 100}}), kNow - seconds(60));
  view.OnMessage(Report("actor", 1, 2, 1, {{"rate", 20}, {"success", 1}, {"episodes", 3}}), kNow);
  view.OnMessage(Report("actor", 2, 3, 1, {{"rate", 30}, {"success", 0}, {"episodes", 1}}), kNow);
  view.OnMessage(Report("actor", 3, 4, 1, {{"episodes", 0}}), kNow);
  EXPECT_EQ(view.Sum("actor", "rate", kNow), 50);
  EXPECT_EQ(view.Mean("actor", "success", "episodes", kNow), 0.75);
}

TEST(MetricsView, ARoleOfSeveralProcessesHasALargestFigureAndAMean) {
  MetricsView view;
  EXPECT_FALSE(view.Largest("learner", "updates"));
  EXPECT_FALSE(view.Average("learner", "updates"));
  view.OnMessage(Report("learner", 0, 1, 1, {{"updates", -20}}), kNow - seconds(60));
  view.OnMessage(Report("learner", 1, 2, 1, {{"updates", -40}}), kNow);
  view.OnMessage(Report("learner", 2, 3, 1, {{"warnings", 1}}), kNow);
  view.OnMessage(Report("replay", 0, 4, 1, {{"updates", 7}}), kNow);
  EXPECT_EQ(view.Largest("learner", "updates"), -20);
  EXPECT_EQ(view.Average("learner", "updates"), -30);
}

TEST(MetricsView, TotalsSurviveRestarts) {
  MetricsView view;
  view.OnMessage(Report("actor", 0, 1, 1, {{"resends", 3}}), kNow);
  view.OnMessage(Report("actor", 0, 1, 2, {{"resends", 5}}), kNow);
  view.OnMessage(Report("actor", 0, 9, 1, {{"resends", 2}}), kNow);
  view.OnMessage(Report("actor", 1, 4, 1, {{"resends", 10}}), kNow);
  EXPECT_EQ(view.Total("actor", "resends"), 17);
}

TEST(MetricsView, ASuccessorMayHaveTheProcessNumberOfItsPredecessor) {
  MetricsView view;
  view.OnMessage(Report("actor", 0, 1, 1, {{"uptime_seconds", 50}, {"resends", 5}}), kNow);
  view.OnMessage(Report("actor", 0, 1, 2, {{"uptime_seconds", 2}, {"resends", 1}}), kNow);
  EXPECT_EQ(view.Total("actor", "resends"), 6) << "as in a container, where everybody is 1";
  MetricsMessage elsewhere = Report("actor", 0, 1, 3, {{"uptime_seconds", 9}, {"resends", 1}});
  elsewhere.host = "another";
  view.OnMessage(elsewhere, kNow);
  EXPECT_EQ(view.Total("actor", "resends"), 7);
}

TEST(MetricsView, ReportsSayWhoIsSilentAndForgetWhoIsGone) {
  MetricsView view;
  view.OnMessage(Report("replay", 0, 3, 1, {{"stored", 1}}), kNow);
  view.OnMessage(Report("actor", 1, 2, 1, {{"made", 2}}), kNow - seconds(6));
  view.OnMessage(Report("actor", 0, 1, 1, {}), kNow - seconds(61));
  const std::vector<MetricsMessage> reports = view.Reports(kNow);
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_EQ(reports[0].role, "actor");
  EXPECT_EQ(reports[0].id, 1u);
  EXPECT_EQ(reports[0].state, "silent");
  EXPECT_EQ(reports[0].values, std::vector<double>{2});
  EXPECT_EQ(reports[1].role, "replay");
  EXPECT_NE(reports[1].state, "silent");
}

}  // namespace
}  // namespace shoal::launch
