// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/reward_tolerance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/base/error.h"

namespace shoal::worlds {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Tolerance, IsOneInsideWithBothBoundsIncluded) {
  for (const double x : {-1.0, 0.5, 2.0}) EXPECT_EQ(Tolerance(x, {.low = -1, .high = 2}), 1) << x;
  EXPECT_EQ(Tolerance(1e9, {.low = 10, .high = kInfinity, .margin = 10}), 1);
}

TEST(Tolerance, WithoutMarginIsZeroOutside) {
  for (const double x : {-1.001, 2.001}) EXPECT_EQ(Tolerance(x, {.low = -1, .high = 2}), 0) << x;
}

TEST(Tolerance, IsTheValueAtOneMarginOnEitherSide) {
  for (const FallOff fall_off : {FallOff::kGaussian, FallOff::kLinear, FallOff::kQuadratic}) {
    for (const double v : {0.1, 0.5}) {
      const ToleranceShape shape{
          .low = -1, .high = 2, .margin = 3, .fall_off = fall_off, .value_at_margin = v};
      EXPECT_NEAR(Tolerance(5, shape), v, 1e-12);
      EXPECT_NEAR(Tolerance(-4, shape), v, 1e-12);
    }
  }
}

// Half a margin outside: exp(ln(0.1) / 4), 1 - 0.9 / 2, 1 - 0.9 / 4.
TEST(Tolerance, FallsOffInItsShape) {
  EXPECT_NEAR(Tolerance(0.5, {.margin = 1}), 0.5623413251903491, 1e-15);
  EXPECT_NEAR(Tolerance(0.5, {.margin = 1, .fall_off = FallOff::kLinear}), 0.55, 1e-15);
  EXPECT_NEAR(Tolerance(0.5, {.margin = 1, .fall_off = FallOff::kQuadratic}), 0.775, 1e-15);
  EXPECT_EQ(Tolerance(9, {.margin = 1, .fall_off = FallOff::kLinear}), 0);
  EXPECT_EQ(Tolerance(9, {.margin = 1, .fall_off = FallOff::kQuadratic}), 0);
}

TEST(Tolerance, AShapeThatCannotBeIsRefused) {
  EXPECT_THROW(Tolerance(2, {.margin = 1, .value_at_margin = 0}), Error) << "a gaussian";
  EXPECT_THROW(Tolerance(2, {.low = 1, .high = 0}), Error);
  EXPECT_THROW(Tolerance(2, {.margin = std::nan("")}), Error);
}

}  // namespace
}  // namespace shoal::worlds
