#include "common/nn/relu_mask.h"

#include <algorithm>

#include "common/base/cpu_clones.h"
#include "common/nn/parallel.h"

namespace shoal::nn {
namespace {

constexpr int64_t kMaskBlock = 1 << 14;  // values per unit of parallel work

SHOAL_CPU_CLONES void MaskFloats(const float* __restrict y, int64_t n, float* __restrict dy) {
  for (int64_t i = 0; i < n; ++i) dy[i] = y[i] > 0 ? dy[i] : 0.f;
}

// A bf16 is above zero exactly if its bits are, read as a signed number.
SHOAL_CPU_CLONES void MaskBf16(const uint16_t* __restrict y, int64_t n, uint16_t* __restrict dy) {
  for (int64_t i = 0; i < n; ++i) dy[i] = int16_t(y[i]) > 0 ? dy[i] : uint16_t(0);
}

template <class Kernel>
void ForMaskBlocks(int64_t n, const Kernel& kernel) {
  ParallelFor(int((n + kMaskBlock - 1) / kMaskBlock), [&](int begin, int end) {
    const int64_t first = begin * kMaskBlock;
    kernel(first, std::min(n, end * kMaskBlock) - first);
  });
}

}  // namespace

void MaskWhereZero(const float* y, int64_t n, float* dy) {
  ForMaskBlocks(n, [&](int64_t first, int64_t count) { MaskFloats(y + first, count, dy + first); });
}

void MaskWhereZero(const uint16_t* y, int64_t n, uint16_t* dy) {
  ForMaskBlocks(n, [&](int64_t first, int64_t count) { MaskBf16(y + first, count, dy + first); });
}

}  // namespace shoal::nn
