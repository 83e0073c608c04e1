// SPDX-License-Identifier: Apache-2.0
#include "common/nn/rows.h"

#include <cstring>
#include <limits>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/nn/bf16.h"

namespace shoal::nn {

Rows::Rows(int batch, int columns, Precision precision) : batch_(batch), columns_(columns) {
  const int64_t numbers = int64_t{batch} * columns;
  if (numbers > std::numeric_limits<int>::max()) {
    throw UsageError(
        "{} rows of {} numbers are {}; expected at most {} in a layer: choose a smaller "
        "learner.batch, network.hidden or network.features",
        batch, columns, numbers, std::numeric_limits<int>::max());
  }
  f32_ = compute_ = MakeMemory(PlainF32({batch, columns}));
  if (precision == Precision::kBf16) {
    compute_ = MakeMemory(dnnl::memory::desc({batch, columns}, dnnl::memory::data_type::bf16,
                                             dnnl::memory::format_tag::ab));
  }
}

void Rows::SetColumns(int first, int count, const float* source) {
  CHECK(first >= 0 && count >= 0 && first + count <= columns_);
  if (count == 0) return;
  for (int b = 0; b < batch_; ++b) {
    std::memcpy(values() + int64_t(b) * columns_ + first, source + int64_t(b) * count,
                size_t(count) * sizeof(float));
  }
}

void Rows::Commit() {
  if (compute_ == f32_) return;
  FloatsToBf16(values(), size(), static_cast<uint16_t*>(compute_.get_data_handle()));
}

}  // namespace shoal::nn
