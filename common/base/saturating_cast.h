// SPDX-License-Identifier: Apache-2.0
// Converts numbers from outside to integers.
#pragma once

#include <cmath>
#include <limits>
#include <type_traits>

namespace shoal {

// Rounds towards zero. A value out of range becomes the nearest limit; NaN becomes 0.
template <class Integer>
Integer SaturatingCast(double value) {
  static_assert(std::is_integral_v<Integer>);
  using Limits = std::numeric_limits<Integer>;
  if (std::isnan(value)) return 0;
  // The largest integer may not be representable as a double. The comparison therefore uses the
  // power of two above it, which is out of range.
  if (value >= std::ldexp(1.0, Limits::digits)) return Limits::max();
  if (value <= static_cast<double>(Limits::min())) return Limits::min();
  return static_cast<Integer>(value);
}

}  // namespace shoal
