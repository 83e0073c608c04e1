// SPDX-License-Identifier: Apache-2.0
#include "learner/engine/batch_part.h"

#include "common/base/check.h"

namespace shoal::learner {

BatchView PartOf(const BatchView& batch, const nn::Replica::Rows& rows) {
  CHECK(rows.begin >= 0 && rows.count > 0 && size_t(rows.begin + rows.count) <= batch.rows())
      << "rows " << rows.begin << " to " << rows.begin + rows.count << " of " << batch.rows();
  const auto first = size_t(rows.begin), count = size_t(rows.count);
  BatchView part = batch;
  part.first_row += first;
  VisitArrays(part, [&]<class T>(const char*, std::span<T>& array) {
    const size_t row = array.size() / batch.rows();
    array = array.subspan(first * row, count * row);
  });
  return part;
}

}  // namespace shoal::learner
