// bf16: the upper 16 bits of an IEEE float32.
#pragma once

#include <cstdint>

namespace shoal::nn {

// Round to nearest, ties to even; infinities stay, NaN stays NaN.
void FloatsToBf16(const float* in, int64_t n, uint16_t* out);
void Bf16ToFloats(const uint16_t* in, int64_t n, float* out);

}  // namespace shoal::nn
