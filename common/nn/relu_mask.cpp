// SPDX-License-Identifier: Apache-2.0
#include "common/nn/relu_mask.h"

#include "common/base/cpu_clones.h"
#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

SHOAL_CPU_CLONES void MaskFloats(const float* __restrict y, int64_t n, float* __restrict dy) {
  for (int64_t i = 0; i < n; ++i) dy[i] = y[i] > 0 ? dy[i] : 0.f;
}

// A bf16 is above zero exactly if its bits, read as a signed number, are.
SHOAL_CPU_CLONES void MaskBf16(const uint16_t* __restrict y, int64_t n, uint16_t* __restrict dy) {
  for (int64_t i = 0; i < n; ++i) dy[i] = int16_t(y[i]) > 0 ? dy[i] : uint16_t(0);
}

}  // namespace

void MaskWhereZero(const float* y, int64_t n, float* dy) {
  ParallelForValues(
      n, [&](int64_t first, int64_t count) { MaskFloats(y + first, count, dy + first); });
}

void MaskWhereZero(const uint16_t* y, int64_t n, uint16_t* dy) {
  ParallelForValues(n,
                    [&](int64_t first, int64_t count) { MaskBf16(y + first, count, dy + first); });
}

}  // namespace shoal::nn
