// SPDX-License-Identifier: Apache-2.0
// An exponential that compilers turn into vector instructions, unlike that of the C library.
#pragma once

#include <bit>
#include <cstdint>

namespace shoal::nn {

// exp(x) for x <= 0, with a relative error of 3e-7. Results below 2^-100 become 2^-100: a sum with
// a term of 1 does not change, and no product is so small that CPUs become slow.
[[gnu::always_inline]] inline float ExpOfNegative(float x) {
  constexpr float kLog2E = 1.44269504f, kLeast = -100;
  constexpr float kRound = 12'582'912;  // 1.5 * 2^23: adding it removes the fraction
  const float t = x * kLog2E < kLeast ? kLeast : x * kLog2E;
  const float rounded = t + kRound;
  const float f = t - (rounded - kRound);  // in [-1/2, 1/2]
  // The series of 2^f.
  float power = 1.5403530e-4f;
  power = power * f + 1.3333558e-3f;
  power = power * f + 9.6181291e-3f;
  power = power * f + 5.5504109e-2f;
  power = power * f + 2.4022651e-1f;
  power = power * f + 6.9314718e-1f;
  power = power * f + 1.f;
  const uint32_t exponent = std::bit_cast<uint32_t>(rounded) - std::bit_cast<uint32_t>(kRound);
  return power * std::bit_cast<float>((exponent + 127u) << 23);
}

}  // namespace shoal::nn
