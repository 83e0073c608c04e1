// SPDX-License-Identifier: Apache-2.0
#include "tests/soak/trend.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/random.h"

namespace shoal::soak {
namespace {

TEST(Trend, AConstantHasNone) {
  Trend trend;
  for (int t = 0; t < 100; ++t) trend.Add(t, 40);
  EXPECT_EQ(trend.Mean(), 40);
  EXPECT_EQ(trend.Slope(), 0);
  EXPECT_EQ(trend.PercentError(), 0);
}

TEST(Trend, GrowthIsInPercentOfTheMeanPerTenMinutes) {
  Trend trend;
  for (int t = 0; t <= 1200; t += 5) trend.Add(t, 90 + t / 60.0);  // 90 to 110: 10 in ten minutes
  EXPECT_NEAR(trend.Mean(), 100, 1e-9);
  EXPECT_NEAR(trend.PercentPerTenMinutes(), 10, 1e-9);
  EXPECT_NEAR(trend.PercentError(), 0, 1e-9);
}

TEST(Trend, AQueueOfNoneThatGrowsIsNotHiddenByItsSmallMean) {
  Trend trend;
  for (int t = 0; t <= 600; t += 5) trend.Add(t, t / 600.0);
  EXPECT_NEAR(trend.PercentPerTenMinutes(), 100, 1e-9);
}

TEST(Trend, ScatterShowsAsErrorNotAsTrend) {
  Random random(3);
  Trend trend;
  for (int t = 0; t <= 1200; t += 5) trend.Add(t, 100 + random.Normal());
  EXPECT_GT(trend.PercentError(), 0.05);
  EXPECT_LT(std::abs(trend.PercentPerTenMinutes()), 5 * trend.PercentError());
}

TEST(Trend, FewSamplesSayNothing) {
  Trend trend;
  EXPECT_EQ(trend.PercentPerTenMinutes(), 0);
  trend.Add(1, 5);
  EXPECT_EQ(trend.Slope(), 0);
  EXPECT_EQ(trend.PercentError(), 0);
}

}  // namespace
}  // namespace shoal::soak
