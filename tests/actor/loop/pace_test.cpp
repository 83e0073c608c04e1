// SPDX-License-Identifier: Apache-2.0
#include "actor/loop/pace.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/lockstep.h"

namespace shoal::actor {
namespace {

using testing::HasSubstr;
using Turn = Pace::Turn;

// Phases end after 4, 6, 8, ... vector steps; each has one update more; the budget is reached in
// phase 2, after 7 of them.
Config LockstepConfig() {
  Config config;
  config.lockstep = true;
  config.lockstep_steps = 2;
  config.envs_per_actor = 3;
  config.env_steps = 21;
  config.replay.min_size = 12;
  config.replay.samples_per_insert = Schedule::Constant(0);
  return config;
}

TEST(FreePace, NeverWaits) {
  FreePace pace;
  EXPECT_EQ(pace.Next(0, {}), Turn::kStep);
  EXPECT_EQ(pace.Next(1'000'000, {}), Turn::kStep);
  EXPECT_TRUE(pace.TakesWeightsAnytime());
}

TEST(LockstepPace, AwaitsTheLastUpdateOfEachPhaseAndRestsAtTheBudget) {
  const Config config = LockstepConfig();
  ASSERT_EQ(LockstepVectorStepsAtPhaseEnd(config, 0), 4);
  ASSERT_EQ(LockstepUpdatesAtPhaseEnd(config, 2), 2u);
  LockstepPace pace(config, 0);
  EXPECT_FALSE(pace.TakesWeightsAnytime());
  // Phase 0 has no updates: it is played on without weights, phase 1 too.
  for (int64_t step = 0; step < 6; ++step) EXPECT_EQ(pace.Next(step, {}), Turn::kStep) << step;
  EXPECT_EQ(pace.phase(), 1);
  EXPECT_EQ(pace.Next(6, {}), Turn::kAwaitWeights);
  EXPECT_THAT(pace.Awaited(), HasSubstr("update 1"));
  EXPECT_EQ(pace.Next(6, {5, 0}), Turn::kAwaitWeights);
  EXPECT_EQ(pace.Next(6, {5, 1}), Turn::kStep);
  EXPECT_EQ(pace.Next(7, {5, 1}), Turn::kStep) << "the phase is played to its end";
  EXPECT_EQ(pace.Next(8, {5, 1}), Turn::kAwaitWeights);
  EXPECT_EQ(pace.Next(8, {5, 2}), Turn::kRest);
  EXPECT_EQ(pace.Next(8, {5, 2}), Turn::kRest) << "and goes on resting";
}

TEST(LockstepPace, GoesOnHalfWayByTheWeightsOfThePhaseBefore) {
  LockstepPace pace(LockstepConfig(), /*vector_steps=*/7);
  EXPECT_EQ(pace.phase(), 2);
  EXPECT_EQ(pace.Next(7, {}), Turn::kAwaitWeights);
  EXPECT_THAT(pace.Awaited(), HasSubstr("update 1"));
  EXPECT_EQ(pace.Next(7, {5, 1}), Turn::kStep);
  EXPECT_EQ(pace.Next(8, {5, 1}), Turn::kAwaitWeights);
}

TEST(LockstepPace, GoesOnAtAPhasesEndByItsOwnWeights) {
  LockstepPace pace(LockstepConfig(), /*vector_steps=*/6);
  EXPECT_EQ(pace.Next(6, {}), Turn::kAwaitWeights);
  EXPECT_EQ(pace.Next(6, {5, 1}), Turn::kStep);
}

TEST(VersionPace, PlaysEachRolloutByOneVersionAndAwaitsANewer) {
  VersionPace pace(/*vector_steps=*/2);
  EXPECT_FALSE(pace.TakesWeightsAnytime());
  EXPECT_EQ(pace.Next(0, {}), Turn::kAwaitWeights) << "nothing is played without a policy";
  EXPECT_EQ(pace.Next(0, {9, 0}), Turn::kStep) << "a session's untrained policy is one";
  EXPECT_EQ(pace.Next(1, {9, 0}), Turn::kStep);
  EXPECT_EQ(pace.Next(2, {9, 0}), Turn::kAwaitWeights);
  EXPECT_THAT(pace.Awaited(), HasSubstr("no weights of update 1"));
  EXPECT_EQ(pace.Next(2, {9, 10}), Turn::kStep);
  EXPECT_EQ(pace.Next(3, {9, 10}), Turn::kStep);
  EXPECT_EQ(pace.Next(4, {9, 10}), Turn::kAwaitWeights);
  EXPECT_EQ(pace.Next(4, {10, 5}), Turn::kStep) << "a newer learner's, whatever its number";
}

TEST(VersionPace, OneVersionAheadPlaysOneRolloutMoreThanItHasWeightsFor) {
  VersionPace pace(/*vector_steps=*/1, /*ahead=*/1);
  EXPECT_EQ(pace.Next(0, {}), Turn::kAwaitWeights);
  EXPECT_EQ(pace.Next(0, {9, 3}), Turn::kStep);
  EXPECT_EQ(pace.Next(1, {9, 3}), Turn::kStep) << "for the update after the next";
  EXPECT_EQ(pace.Next(2, {9, 3}), Turn::kAwaitWeights);
  EXPECT_THAT(pace.Awaited(), HasSubstr("no weights of update 4"));
  EXPECT_EQ(pace.Next(2, {9, 4}), Turn::kStep);
  EXPECT_EQ(pace.Next(3, {9, 4}), Turn::kAwaitWeights) << "it never falls further behind";
  EXPECT_EQ(pace.Next(3, {9, 8}), Turn::kStep) << "the learner went on without it";
  EXPECT_EQ(pace.Next(4, {9, 8}), Turn::kStep);
  EXPECT_EQ(pace.Next(5, {9, 8}), Turn::kAwaitWeights);
}

TEST(MakePace, IsWhatTheConfigurationAsksFor) {
  Config config = LockstepConfig();
  EXPECT_FALSE(MakePace(config, 0)->TakesWeightsAnytime());
  EXPECT_EQ(MakePace(config, 6)->Next(6, {}), Turn::kAwaitWeights);
  config.lockstep = false;
  EXPECT_TRUE(MakePace(config, 0)->TakesWeightsAnytime());
}

}  // namespace
}  // namespace shoal::actor
