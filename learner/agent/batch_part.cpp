// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/batch_part.h"

#include "common/base/check.h"

namespace shoal::learner {

BatchView PartOf(const BatchView& batch, int index, int parts) {
  CHECK(batch.rows() > 0 && batch.rows() % size_t(parts) == 0)
      << batch.rows() << " rows in " << parts << " parts";
  const size_t rows = batch.rows() / size_t(parts), first = rows * size_t(index);
  BatchView part = batch;
  part.first_row += first;
  VisitArrays(part, [&]<class T>(const char*, std::span<T>& array) {
    const size_t row = array.size() / batch.rows();
    array = array.subspan(first * row, rows * row);
  });
  return part;
}

}  // namespace shoal::learner
