// SPDX-License-Identifier: Apache-2.0
// Numbers from outside as integers.
#pragma once

#include <cmath>
#include <limits>
#include <type_traits>

namespace shoal {

// Towards zero; what does not fit becomes the nearest that does, NaN becomes 0.
template <class Integer>
Integer SaturatingCast(double value) {
  static_assert(std::is_integral_v<Integer>);
  using Limits = std::numeric_limits<Integer>;
  if (std::isnan(value)) return 0;
  // The largest integer may be no double: 2^63 or 2^64 then stand for it, and do not fit.
  if (value >= std::ldexp(1.0, Limits::digits)) return Limits::max();
  if (value <= static_cast<double>(Limits::min())) return Limits::min();
  return static_cast<Integer>(value);
}

}  // namespace shoal
