// SPDX-License-Identifier: Apache-2.0
#include "common/wire/quantile_window.h"

#include <gtest/gtest.h>

namespace shoal {
namespace {

TEST(QuantileWindow, AreNearestRanksOfWhatWasAdded) {
  QuantileWindow window;
  for (int i = 100; i >= 1; --i) window.Add(i);
  const auto quantiles = window.Take();
  ASSERT_TRUE(quantiles);
  EXPECT_EQ(quantiles->p50, 50);
  EXPECT_EQ(quantiles->p90, 90);
  EXPECT_EQ(quantiles->p99, 99);
}

TEST(QuantileWindow, EachIntervalStandsForItself) {
  QuantileWindow window;
  EXPECT_FALSE(window.Take());
  window.Add(7);
  EXPECT_EQ(window.Take()->p99, 7);
  EXPECT_FALSE(window.Take());
  window.Add(3);
  EXPECT_EQ(window.Take()->p50, 3);
}

// A ramp of a hundred times the memory: each quantile is within the spacing of what is kept.
TEST(QuantileWindow, ManyValuesAreThinnedEvenly) {
  QuantileWindow window;
  constexpr double kValues = 100.0 * QuantileWindow::kMost;
  for (double i = 0; i < kValues; ++i) window.Add(i / kValues);
  const auto quantiles = window.Take();
  ASSERT_TRUE(quantiles);
  constexpr double kSpacing = 2.0 / QuantileWindow::kMost;
  EXPECT_NEAR(quantiles->p50, 0.5, kSpacing);
  EXPECT_NEAR(quantiles->p90, 0.9, kSpacing);
  EXPECT_NEAR(quantiles->p99, 0.99, kSpacing);
}

}  // namespace
}  // namespace shoal
