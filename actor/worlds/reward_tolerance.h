// SPDX-License-Identifier: Apache-2.0
// The Control Suite's building block of rewards: 1 inside an interval, smaller outside.
//
//   Tolerance(x) = 1                 for low <= x <= high
//                  S(d s)            outside, d = distance to the nearer bound / margin
//                  0                 outside, if margin = 0
//
//   fall-off    S(z)               scale s, so that S = v at one margin
//   gaussian    exp(-z^2 / 2)      sqrt(-2 ln v), 0 < v < 1
//   linear      max(0, 1 - z)      1 - v,         0 <= v < 1
//   quadratic   max(0, 1 - z^2)    sqrt(1 - v),   0 <= v < 1
#pragma once

namespace shoal::worlds {

enum class FallOff { kGaussian, kLinear, kQuadratic };

struct ToleranceShape {
  double low = 0, high = 0;  // low <= high; infinite for a one-sided interval
  double margin = 0;         // >= 0
  FallOff fall_off = FallOff::kGaussian;
  double value_at_margin = 0.1;  // v
};

// CHECK: the shape is within these bounds.
double Tolerance(double x, const ToleranceShape& shape);

}  // namespace shoal::worlds
