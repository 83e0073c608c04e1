// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/sample_figures.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

ObservationSpec GoalSpec() {
  ObservationSpec spec = SmallSpec();
  spec.blocks = {{"achieved_goal", 2}, {"grip", 1}, {"desired_goal", 2}};
  return spec;
}

UpdateFigures FiguresOf(const BatchView& batch, const ObservationSpec& spec) {
  UpdateFigures figures;
  AddSampleFigures(batch, spec, &figures);
  return figures;
}

TEST(SampleFigures, SayWhatRewardsABatchHas) {
  const RandomBatch batch(SmallSpec(), 4, 1);
  std::ranges::copy(std::array{-1.f, 0.f, -1.f, -2.f}, batch.View().reward.begin());
  const UpdateFigures figures = FiguresOf(batch.View(), SmallSpec());
  EXPECT_EQ(figures.Get(kRewardMean), -1);
  EXPECT_NEAR(*figures.Get(kRewardStd), std::sqrt(0.5), 1e-12);
  EXPECT_EQ(figures.Get(kRewardMin), -2);
  EXPECT_EQ(figures.Get(kRewardMax), 0);
  EXPECT_EQ(figures.Get(kRewardAboveMinusHalf), 0.25);
  EXPECT_FALSE(figures.Get(kGoalDistanceMean));
}

TEST(SampleFigures, SayHowFarGoalsAreWhereThePolicySeesBoth) {
  const RandomBatch batch(GoalSpec(), 2, 1);
  // Achieved (2), grip, desired (2): 0.5 and 0.04 apart.
  std::ranges::copy(std::array{0.f, 0.f, 9.f, 0.3f, 0.4f, 1.f, 1.f, 9.f, 1.f, 1.04f},
                    batch.View().next_obs_vector.begin());
  const UpdateFigures figures = FiguresOf(batch.View(), GoalSpec());
  EXPECT_NEAR(*figures.Get(kGoalDistanceMean), 0.27, 1e-6);
  EXPECT_NEAR(*figures.Get(kGoalDistanceStd), 0.23, 1e-6);
  EXPECT_NEAR(*figures.Get(kGoalDistanceMin), 0.04, 1e-6);
  EXPECT_NEAR(*figures.Get(kGoalDistanceMax), 0.5, 1e-6);
  EXPECT_EQ(figures.Get(kGoalWithin), 0.5);
}

TEST(SampleFigures, OfARolloutAreNone) {
  const RandomBatch rollout(GoalSpec(), 4, 1, /*rollout=*/true);
  EXPECT_TRUE(FiguresOf(rollout.View(), GoalSpec()).empty());
}

}  // namespace
}  // namespace shoal::learner
