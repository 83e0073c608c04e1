// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/frames_results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

FramesRun RunAt100(int64_t seed, std::optional<double> at_100) {
  FramesRun run{.seed = seed};
  if (at_100) run.returns.push_back({.frames = 100, .return_mean = *at_100});
  return run;
}

// Seed 2 has not reached the frames on "b"; seed 3 has failed on "b".
std::vector<FramesArm> TwoTasks() {
  FramesRun failed{.seed = 3, .failed = true};
  return {{.name = "a",
           .task = "ta",
           .runs = {RunAt100(0, 10), RunAt100(1, 30), RunAt100(2, 5), RunAt100(3, 7)}},
          {.name = "b",
           .task = "tb",
           .runs = {RunAt100(0, 100), RunAt100(1, 300), RunAt100(2, std::nullopt), failed}}};
}

TEST(ReturnsAtFrames, HasOnlyFramesThatTheRunHasEvaluated) {
  RunResults run;
  run.config.task = "cartpole_swingup";
  run.curve = {{.env_steps = 12'504, .episodes = 10, .return_mean = 700},
               {.env_steps = 25'000, .episodes = 10, .return_mean = 800}};
  const auto returns = ReturnsAtFrames(run, {100'000, 500'000});
  ASSERT_EQ(returns.size(), 1u);
  EXPECT_EQ(returns[0].env_steps, 12'504u) << "8 control steps each";
  EXPECT_EQ(returns[0].return_mean, 700);
}

TEST(FiguresAt, CountsFailedSeedsAndSkipsUnfinishedOnes) {
  const SeedFigures figures = FiguresAt(TwoTasks()[1], 100);
  EXPECT_THAT(figures.returns, ElementsAre(100, 300));
  EXPECT_EQ(figures.failed, 1u);
  EXPECT_THAT(FiguresAt(TwoTasks()[1], 500).returns, IsEmpty());
}

TEST(MeanOfTasksAt, IsTheMeanOfSeedsThatAllTasksHave) {
  const SeedFigures figures = MeanOfTasksAt(TwoTasks(), 100);
  EXPECT_THAT(figures.returns, ElementsAre(55, 165));
  EXPECT_EQ(figures.failed, 1u);
}

TEST(MeanOfTasksAt, IsOfDifferentTasksOnly) {
  std::vector<FramesArm> arms = TwoTasks();
  EXPECT_TRUE(AreDifferentTasks(arms));
  arms.push_back({.name = "c", .task = "ta"});
  EXPECT_FALSE(AreDifferentTasks(arms)) << "two arms of one task would count it twice";
  EXPECT_FALSE(AreDifferentTasks({arms[0]}));
}

TEST(SetReference, TakesTheTasksAndFramesOfTheExperiment) {
  FramesResults results{.frames = {100}, .arms = TwoTasks()};
  SetReference({.name = "r",
                .source = "s",
                .results = {{.method = "M", .task = "ta", .frames = {50, 100}, .returns = {1, 2}},
                            {.method = "N", .task = "ta", .frames = {100}, .returns = {5}},
                            {.method = "M", .task = "tb", .frames = {100}, .returns = {4}},
                            {.method = "M", .task = "tc", .frames = {100}, .returns = {9}}}},
               &results);
  EXPECT_EQ(results.reference, "r");
  EXPECT_EQ(results.source, "s");
  EXPECT_EQ(results.published.size(), 3u);
  EXPECT_THAT(MethodsOf(results), ElementsAre("M", "N"));
  EXPECT_EQ(PublishedAt(results, "M", "ta", 100), 2);
  EXPECT_FALSE(PublishedAt(results, "M", "ta", 50));
  EXPECT_EQ(PublishedMeanAt(results, "M", 100), 3);
  EXPECT_FALSE(PublishedMeanAt(results, "N", 100)) << "one task is missing";
}

}  // namespace
}  // namespace shoal::launch
