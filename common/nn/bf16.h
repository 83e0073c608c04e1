// SPDX-License-Identifier: Apache-2.0
// bf16: the upper 16 bits of an IEEE float32.
#pragma once

#include <bit>
#include <cstdint>

namespace shoal::nn {

// Round to nearest, ties to even; infinities stay, NaN stays NaN.
void FloatsToBf16(const float* in, int64_t n, uint16_t* out);
void Bf16ToFloats(const uint16_t* in, int64_t n, float* out);

// One value, f32 or bf16, for loops that are written once for both.
[[gnu::always_inline]] inline float ToFloat(float value) { return value; }
[[gnu::always_inline]] inline float ToFloat(uint16_t bf16) {
  return std::bit_cast<float>(uint32_t{bf16} << 16);
}
[[gnu::always_inline]] inline void Store(float value, float* out) { *out = value; }
// Same as FloatsToBf16, except for a NaN whose set bits are all in the lower half: it would become
// an infinity. Arithmetic does not produce such a NaN.
[[gnu::always_inline]] inline void Store(float value, uint16_t* out) {
  const auto bits = std::bit_cast<uint32_t>(value);
  *out = uint16_t((bits + 0x7fffu + ((bits >> 16) & 1u)) >> 16);
}

}  // namespace shoal::nn
