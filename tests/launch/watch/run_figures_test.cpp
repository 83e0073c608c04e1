// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/run_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/wire/metric_names.h"
#include "common/wire/process_name.h"
#include "tests/launch/watch/report_message.h"

namespace shoal::launch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

// A run on four cores whose learner waits for two actors.
Bottleneck Lately() {
  RunTotals totals;
  totals["actor"] = {
      .processes = 2, .seconds = 60, .cpu_seconds = 30, .stages = {{"rendering", 45}}};
  totals["replay"] = {
      .processes = 1, .seconds = 30, .stages = {{"idle", 29}}, .samples_blocked = 15};
  totals["learner"] = {
      .processes = 1, .seconds = 30, .cpu_seconds = 15, .stages = {{"backward", 9}}};
  return FindBottleneck(totals, {.usable_cores = 4, .actors = 2});
}

// The view of a coordinator.
RunViewMessage ViewOf(const ProgressFigures& figures, const Bottleneck& lately) {
  Config config;
  config.env_steps = 4000;
  MetricsReport report(ProcessName::Coordinator());
  report.Begin(figures.state);
  AddRunFigures(figures, &report);
  AddOrders(config, {.usable_cores = 4, .actors = 2}, &report);
  MetricsMessage own = report.message();
  AddShares(lately, &own);
  return {.run = "reach",
          .state = figures.state,
          .env_steps = figures.env_steps,
          .processes = {own},
          .trouble = figures.trouble};
}

ProgressFigures Figures() {
  ProgressFigures figures;
  figures.state = "running";
  figures.elapsed_seconds = 60;
  figures.env_steps = 1000;
  figures.budget = 4000;
  figures.env_steps_per_second = 75;
  figures.seconds_left = 40;
  figures.last_evaluation = EvaluationPoint{.env_steps = 900,
                                            .success = std::nullopt,
                                            .mean_return = 312.5,
                                            .return_std = 8,
                                            .mean_length = 740,
                                            .episodes = 20};
  AddLately(RecentRun(), Lately(), &figures);
  figures.seconds_left = 40;
  return figures;
}

TEST(RunFigures, AViewShowsWhatTheCoordinatorShows) {
  const ProgressFigures figures = Figures();
  const ProgressFigures seen = FiguresOfView(ViewOf(figures, Lately()), Now());
  EXPECT_EQ(seen.env_steps_per_second, 75);
  EXPECT_EQ(seen.seconds_left, 40);
  EXPECT_EQ(seen.learner_waits, 0.5);
  EXPECT_EQ(seen.actors_wait, 0);
  ASSERT_TRUE(seen.last_evaluation);
  EXPECT_EQ(FormatScore(*seen.last_evaluation), FormatScore(*figures.last_evaluation));
}

TEST(RunFigures, AViewShowsWhichActorsDoNotWork) {
  ProgressFigures figures = Figures();
  figures.actors_working = 1;
  figures.trouble = "actors 1 of 2: actor-1: exit code 1";
  RunViewMessage view = ViewOf(figures, Lately());
  EXPECT_EQ(FiguresOfView(view, Now()).actors_working, 1);
  EXPECT_EQ(FiguresOfView(view, Now()).trouble, figures.trouble);
  view.state = "evaluating";
  EXPECT_EQ(FiguresOfView(view, Now()).trouble, "") << "no actor is wanted any more";
}

TEST(RunFigures, AViewGivesTheAdviceOfWhatWasLately) {
  const RunViewMessage view = ViewOf(Figures(), Lately());
  EXPECT_EQ(AdviceOfView(view), Lately().advice);
  EXPECT_THAT(AdviceOfView(view), AllOf(HasSubstr("learner waits for the actors 50 %"),
                                        HasSubstr("75 % of their time in rendering"),
                                        HasSubstr("shoal scale --actors 3")));
  for (const std::string& name : view.processes[0].names) {
    EXPECT_NE(FindMetric(ProcessMetrics(), "coordinator", name), nullptr) << name;
  }
}

TEST(RunFigures, ARunThatHasNoProcessesAnyMoreHasNoRates) {
  ProgressFigures figures = Figures();
  RunViewMessage view = ViewOf(figures, Lately());
  view.state = "evaluating";
  const ProgressFigures seen = FiguresOfView(view, Now());
  EXPECT_FALSE(seen.env_steps_per_second);
  EXPECT_FALSE(seen.seconds_left);
  EXPECT_FALSE(seen.learner_waits);
  EXPECT_TRUE(seen.last_evaluation);
  EXPECT_THAT(AdviceOfView(view), HasSubstr("final evaluation"));
  view.state = "ended";
  EXPECT_EQ(AdviceOfView(view), "The run has ended.");
  view.state = "draining";
  EXPECT_THAT(AdviceOfView(view), HasSubstr("ending"));
}

TEST(RunFigures, ActorsTellOfTheirEpisodes) {
  MetricsView view;
  view.OnMessage(
      Report("actor", 0, 1, 1, {{"rollout_return", 30}, {"rollout_length", 100}, {"episodes", 3}}),
      Now());
  view.OnMessage(
      Report("actor", 1, 2, 1, {{"rollout_return", 10}, {"rollout_length", 20}, {"episodes", 1}}),
      Now());
  const ProgressFigures figures = CollectFigures(view, Now());
  EXPECT_EQ(figures.rollout_return, 25);
  EXPECT_EQ(figures.rollout_length, 80);
  EXPECT_FALSE(figures.rollout_success);
}

}  // namespace
}  // namespace shoal::launch
