// SPDX-License-Identifier: Apache-2.0
#include "common/nn/bf16.h"

#include "common/base/cpu_clones.h"

namespace shoal::nn {

SHOAL_CPU_CLONES void FloatsToBf16(const float* in, int64_t n, uint16_t* out) {
  for (int64_t i = 0; i < n; ++i) {
    const uint32_t bits = std::bit_cast<uint32_t>(in[i]);
    uint16_t rounded;
    Store(in[i], &rounded);
    const bool nan = (bits & 0x7fffffffu) > 0x7f800000u;  // rounding could turn it into infinity
    out[i] = uint16_t(nan ? (bits >> 16) | 0x40u : rounded);
  }
}

SHOAL_CPU_CLONES void Bf16ToFloats(const uint16_t* in, int64_t n, float* out) {
  for (int64_t i = 0; i < n; ++i) out[i] = ToFloat(in[i]);
}

}  // namespace shoal::nn
