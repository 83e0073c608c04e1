// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/reward_tolerance.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::worlds {

double Tolerance(double x, const ToleranceShape& shape) {
  const double v = shape.value_at_margin;
  if (!(shape.low <= shape.high && shape.margin >= 0)) {
    throw UsageError("Tolerance: bounds [{}, {}], margin {}; expected low <= high, margin >= 0",
                     shape.low, shape.high, shape.margin);
  }
  if (!(v >= 0 && v < 1 && (v > 0 || shape.fall_off != FallOff::kGaussian))) {
    throw UsageError(
        "Tolerance: value_at_margin is {}; expected 0 to below 1, above 0 of a gaussian", v);
  }
  if (x >= shape.low && x <= shape.high) return 1;
  if (shape.margin == 0) return 0;
  const double d = (x < shape.low ? shape.low - x : x - shape.high) / shape.margin;
  switch (shape.fall_off) {
    case FallOff::kGaussian:
      return std::exp(d * d * std::log(v));
    case FallOff::kLinear:
      return std::max(0.0, 1 - d * (1 - v));
    case FallOff::kQuadratic:
      return std::max(0.0, 1 - d * d * (1 - v));
  }
  CHECK(false) << "fall-off " << int(shape.fall_off);
  return 0;
}

}  // namespace shoal::worlds
