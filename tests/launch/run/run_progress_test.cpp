// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_progress.h"

#include <gtest/gtest.h>

#include <string>

namespace shoal::launch {
namespace {

TEST(RunProgress, AddsTheStepsOfAllReplays) {
  RunProgress progress;
  EXPECT_EQ(progress.stored_steps(), 0u);
  progress.OnReplay({.replay = 0, .session = 1, .stored_steps = 100, .stored_records = 110});
  progress.OnReplay({.replay = 1, .session = 1, .stored_steps = 50, .stored_records = 55});
  progress.OnReplay({.replay = 0, .session = 1, .stored_steps = 120, .stored_records = 130});
  EXPECT_EQ(progress.stored_steps(), 170u);
}

TEST(RunProgress, WithoutAReplayTheLearnerCounts) {
  RunProgress progress;
  progress.OnLearner({.session = 1, .updates = 3, .env_steps = 2048});
  EXPECT_EQ(progress.stored_steps(), 2048u);
  progress.OnReplay({.session = 1, .stored_steps = 5000, .stored_records = 5100});
  EXPECT_EQ(progress.stored_steps(), 5000u);
}

TEST(RunProgress, TheNewestSessionHasTheWord) {
  RunProgress progress;
  EXPECT_EQ(progress.updates(), std::nullopt);
  progress.OnReplay({.session = 2, .stored_steps = 10, .stored_records = 10});
  progress.OnReplay({.session = 1, .stored_steps = 99, .stored_records = 99});
  EXPECT_EQ(progress.stored_steps(), 10u);
  progress.OnLearner({.session = 2, .updates = 20});
  progress.OnLearner({.session = 1, .updates = 30, .drained = true});
  EXPECT_EQ(progress.updates(), 20u);
  EXPECT_FALSE(progress.drained());
  progress.OnLearner({.session = 3, .updates = 15, .drained = true});
  EXPECT_EQ(progress.updates(), 15u) << "a restarted learner begins at its checkpoint";
  EXPECT_TRUE(progress.drained());
}

TEST(RunProgress, EnvStepsNeverFall) {
  RunProgress progress;
  EXPECT_FALSE(progress.OnReplay({.session = 1, .stored_steps = 1000, .stored_records = 1020}));
  EXPECT_TRUE(progress.OnReplay({.session = 2, .stored_steps = 950, .stored_records = 10}));
  EXPECT_EQ(progress.stored_steps(), 1000u) << "the successor of a replay whose memory is gone";
  EXPECT_FALSE(progress.OnReplay({.session = 2, .stored_steps = 1010, .stored_records = 70}));
  EXPECT_EQ(progress.stored_steps(), 1010u);
  EXPECT_FALSE(progress.OnReplay({.session = 3, .stored_steps = 1010, .stored_records = 70}))
      << "the ring is a file";
}

TEST(RunProgress, AnEvaluationIsAskedForByTheLearnerThatMadeItsParameters) {
  RunProgress progress;
  EvaluationPoint point;
  point.env_steps = 1000;
  point.updates = 7;
  point.checkpoint = "a";
  point.learner_session = 1;
  EXPECT_FALSE(progress.AskedFor(point));
  EXPECT_EQ(progress.evaluation_due(), 0u);
  progress.OnLearner({.session = 1,
                      .updates = 9,
                      .evaluations = {{.update = 5, .env_steps = 500, .checkpoint = "b"},
                                      {.update = 7, .env_steps = 1000, .checkpoint = "a"}}});
  EXPECT_TRUE(progress.AskedFor(point));
  EXPECT_EQ(progress.evaluation_due(), 7u);
  progress.OnLearner({.session = 2, .updates = 5});
  EXPECT_EQ(progress.evaluation_due(), 0u);
  EXPECT_TRUE(progress.AskedFor(point)) << "the evaluation of a learner that died since counts";
  for (const auto& change : {&EvaluationPoint::env_steps, &EvaluationPoint::updates,
                             &EvaluationPoint::learner_session}) {
    EvaluationPoint other = point;
    ++(other.*change);
    EXPECT_FALSE(progress.AskedFor(other));
  }
  point.checkpoint = std::string("b");
  EXPECT_FALSE(progress.AskedFor(point));
}

}  // namespace
}  // namespace shoal::launch
