// SPDX-License-Identifier: Apache-2.0
#include "launch/run/evaluation_filter.h"

#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

EvaluationPoint PointAt(uint64_t env_steps, uint64_t session, uint64_t updates) {
  EvaluationPoint point;
  point.env_steps = env_steps;
  point.updates = updates;
  point.learner_session = session;
  return point;
}

TEST(EvaluationFilter, CountsEachPointOnce) {
  EvaluationFilter filter;
  EXPECT_TRUE(filter.Accept(PointAt(1000, 7, 100)));
  EXPECT_FALSE(filter.Accept(PointAt(1000, 7, 100)));
  EXPECT_TRUE(filter.Accept(PointAt(2000, 7, 200)));
  EXPECT_EQ(filter.repeated(), 1u);
}

// The transport delivers its stored messages again, after newer ones were counted.
TEST(EvaluationFilter, WhatComesAgainInItsOldOrderDoesNotCount) {
  EvaluationFilter filter;
  for (uint64_t i = 1; i <= 4; ++i) EXPECT_TRUE(filter.Accept(PointAt(1000 * i, 7, 100 * i)));
  for (uint64_t i = 1; i <= 4; ++i) EXPECT_FALSE(filter.Accept(PointAt(1000 * i, 7, 100 * i)));
  EXPECT_TRUE(filter.Accept(PointAt(5000, 7, 500)));
}

TEST(EvaluationFilter, ARestartedLearnerStartsFromFewerUpdatesAndCounts) {
  EvaluationFilter filter;
  EXPECT_TRUE(filter.Accept(PointAt(3000, 7, 300)));
  EXPECT_TRUE(filter.Accept(PointAt(4000, 8, 250)));
  EXPECT_FALSE(filter.Accept(PointAt(3500, 7, 350))) << "late, of the learner that is gone";
}

TEST(EvaluationFilter, TheSameCheckpointHandedOutAgainByAResumedLearnerDoesNotCount) {
  EvaluationFilter filter;
  EXPECT_TRUE(filter.Accept(PointAt(3000, 7, 300)));
  EXPECT_FALSE(filter.Accept(PointAt(3000, 8, 300)));
  EXPECT_TRUE(filter.Accept(PointAt(3000, 8, 310))) << "the same env steps, other parameters";
}

}  // namespace
}  // namespace shoal::launch
