// SPDX-License-Identifier: Apache-2.0
#include "learner/engine/moments.h"

#include <gtest/gtest.h>

namespace shoal::learner {
namespace {

TEST(Moments, AreZeroAndOneBeforeAnyVector) {
  const std::vector<double> moments(MomentsSize(2));
  EXPECT_EQ(MeanOf(moments), (std::vector<float>{0, 0}));
  EXPECT_EQ(VarianceOf(moments), (std::vector<float>{1, 1}));
}

TEST(Moments, OfTwoBatchesAreThoseOfAllVectors) {
  std::vector<double> moments(MomentsSize(2));
  AddToMoments(std::vector<float>{1, 10, 2, 10}, moments);
  AddToMoments(std::vector<float>{6, 10}, moments);
  AddToMoments({}, moments);
  EXPECT_EQ(moments[0], 3);
  EXPECT_EQ(MeanOf(moments), (std::vector<float>{3, 10}));
  EXPECT_NEAR(VarianceOf(moments)[0], 14.0 / 3, 1e-6);
  EXPECT_EQ(VarianceOf(moments, 0.25f)[1], 0.25f);
}

}  // namespace
}  // namespace shoal::learner
