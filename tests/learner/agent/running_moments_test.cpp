// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/running_moments.h"

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace shoal::learner {
namespace {

TEST(RunningMoments, OfTwoBatchesAreThoseOfAllNumbers) {
  RunningMoments moments(2);
  moments.Add(std::vector<float>{1, 10, 2, 20});
  moments.Add(std::vector<float>{6, 60});
  EXPECT_EQ(moments.Mean(), (std::vector<float>{3, 30}));
  EXPECT_NEAR(moments.Variance()[0], 14.0 / 3, 1e-6);
  nn::TensorMap tensors;
  moments.Export("m", &tensors);
  RunningMoments other(2);
  other.Import(tensors, "m", "test");
  EXPECT_EQ(other.Variance(), moments.Variance());
  EXPECT_EQ(other.count(), 3);
}

TEST(RunningMoments, OfAnotherWidthAreRefusedAndChangeNothing) {
  RunningMoments moments(2), wider(3);
  moments.Add(std::vector<float>{1, 10, 2, 20});
  wider.Add(std::vector<float>{1, 2, 3});
  nn::TensorMap tensors;
  wider.Export("m", &tensors);
  EXPECT_THROW(moments.Import(tensors, "m", "test"), Error);
  EXPECT_EQ(moments.count(), 2);
}

}  // namespace
}  // namespace shoal::learner
