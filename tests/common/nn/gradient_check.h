// SPDX-License-Identifier: Apache-2.0
// Comparison of arrays with the naive reference.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/base/random.h"
#include "common/nn/precision.h"
#include "tests/common/nn/reference.h"

namespace shoal::nn {

// Largest |fast - exact| as a share of the largest |exact|.
inline double RelativeError(std::span<const float> fast, const reference::Values& exact) {
  EXPECT_EQ(fast.size(), exact.size());
  double error = 0, scale = 0;
  for (size_t i = 0; i < std::min(fast.size(), exact.size()); ++i) {
    const double difference = std::abs(fast[i] - exact[i]);
    error = std::isnan(difference) ? INFINITY : std::max(error, difference);
    scale = std::max(scale, std::abs(exact[i]));
  }
  return error / scale;
}

// Products in f32 differ from double only by rounding. bf16 has 8 bits of mantissa, so rounding in
// several layers gives an error of a few per cent.
inline double Tolerance(Precision precision) { return precision == Precision::kF32 ? 2e-5 : 0.04; }

// Values in [-1, 1], exact in f32 but not in bf16, so that wrong rounding in a layer is detected.
inline reference::Values RandomValues(size_t n, uint64_t key) {
  Random random(key);
  reference::Values values(n);
  for (double& value : values) value = double(float(random.Uniform(-1, 1)));
  return values;
}

inline std::vector<float> ToFloats(const reference::Values& values) {
  return {values.begin(), values.end()};
}

inline reference::Values ToDoubles(std::span<const float> values) {
  return {values.begin(), values.end()};
}

// d loss / d value by central differences; restores `value`.
inline double CentralDifference(double* value, const std::function<double()>& loss) {
  constexpr double kStep = 1e-6;  // small, so that it seldom crosses the edge of a ReLU
  const double former = *value;
  *value = former + kStep;
  const double above = loss();
  *value = former - kStep;
  const double below = loss();
  *value = former;
  return (above - below) / (2 * kStep);
}

inline double Dot(const reference::Values& a, const reference::Values& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace shoal::nn
