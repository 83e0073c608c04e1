// SPDX-License-Identifier: Apache-2.0
// bf16: the upper 16 bits of an IEEE float32.
#pragma once

#include <bit>
#include <cstdint>

namespace shoal::nn {

// Rounds n values to the nearest bf16, ties to even. Infinities stay infinite, NaN stays NaN.
void FloatsToBf16(const float* in, int64_t n, uint16_t* out);
// Converts n values exactly.
void Bf16ToFloats(const uint16_t* in, int64_t n, float* out);

// Conversions of one value, for loops that are templates over the type (float or bits of a bf16).
[[gnu::always_inline]] inline float ToFloat(float value) { return value; }
[[gnu::always_inline]] inline float ToFloat(uint16_t bf16) {
  return std::bit_cast<float>(uint32_t{bf16} << 16);
}
[[gnu::always_inline]] inline void Store(float value, float* out) { *out = value; }
// Rounds like FloatsToBf16. Exception: a NaN whose mantissa has set bits only in the lower 16 bits
// becomes an infinity. Arithmetic does not produce such a NaN.
[[gnu::always_inline]] inline void Store(float value, uint16_t* out) {
  const auto bits = std::bit_cast<uint32_t>(value);
  *out = uint16_t((bits + 0x7fffu + ((bits >> 16) & 1u)) >> 16);
}

}  // namespace shoal::nn
