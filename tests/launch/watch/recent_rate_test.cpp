// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/recent_rate.h"

#include <gtest/gtest.h>

namespace shoal::launch {
namespace {

TEST(RecentRate, IsUnknownUntilSomeTimeHasPassed) {
  RecentRate rate;
  EXPECT_EQ(rate.Add(0, 0), std::nullopt);
  EXPECT_EQ(rate.Add(2, 100), std::nullopt);
  EXPECT_EQ(rate.Add(4, 100), 25);
}

TEST(RecentRate, IsLevelWhereACountGrowsInChunks) {
  RecentRate rate;
  std::optional<double> last;
  for (int second = 0; second <= 100; ++second) {
    last = rate.Add(second, second / 5 * 100);  // a hundred every five seconds
    if (second < 30) continue;
    ASSERT_TRUE(last);
    EXPECT_NEAR(*last, 20, 4) << second;
  }
}

TEST(RecentRate, ForgetsWhatWasBeforeTheWindow) {
  RecentRate rate;
  for (int second = 0; second <= 60; ++second) rate.Add(second, 1000.0 * second);
  for (int second = 61; second <= 60 + 31; ++second) rate.Add(second, 60000);
  EXPECT_EQ(rate.Add(92, 60000), 0);
}

TEST(RecentRate, BeginsAnewWhereTheCountHasFallen) {
  RecentRate rate;
  rate.Add(0, 0);
  EXPECT_EQ(rate.Add(10, 1000), 100);
  EXPECT_EQ(rate.Add(11, 500), std::nullopt);
  EXPECT_EQ(rate.Add(15, 700), 50);
}

}  // namespace
}  // namespace shoal::launch
