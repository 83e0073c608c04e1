// SPDX-License-Identifier: Apache-2.0
#include "learner/engine/columns.h"

#include <algorithm>

#include "common/base/check.h"

namespace shoal::learner {

void JoinColumns(size_t rows, std::span<const float> left, std::span<const float> right,
                 std::span<const ObservationSpec::Range> ranges, std::span<float> joined) {
  const size_t left_width = left.size() / rows, right_width = right.size() / rows;
  auto out = joined.begin();
  for (size_t b = 0; b < rows; ++b) {
    out = std::ranges::copy(left.subspan(b * left_width, left_width), out).out;
    for (const auto& [first, size] : ranges) {
      const auto columns = right.subspan(b * right_width + size_t(first), size_t(size));
      out = std::ranges::copy(columns, out).out;
    }
  }
  CHECK(out == joined.end()) << joined.size() << " numbers in " << rows << " rows";
}

void SplitColumns(size_t rows, std::span<const float> joined, std::span<float> left,
                  std::span<float> right) {
  CHECK(joined.size() == left.size() + right.size()) << joined.size();
  const size_t left_width = left.size() / rows, right_width = right.size() / rows;
  for (size_t b = 0; b < rows; ++b) {
    const auto row = joined.subspan(b * (left_width + right_width), left_width + right_width);
    std::ranges::copy(row.first(left_width), left.subspan(b * left_width).begin());
    std::ranges::copy(row.last(right_width), right.subspan(b * right_width).begin());
  }
}

void GatherLabels(size_t rows, std::span<const float> observed, std::span<const float> privileged,
                  std::span<const LabelColumns> columns, float unit, std::span<float> labels) {
  CHECK(labels.size() == rows * columns.size()) << labels.size();
  const auto value = [&](size_t row, const LabelColumns::Column& column) {
    const std::span<const float> vectors = column.observed ? observed : privileged;
    return vectors[row * (vectors.size() / rows) + column.at];
  };
  for (size_t i = 0; i < labels.size(); ++i) {
    const size_t row = i / columns.size();
    const LabelColumns& label = columns[i % columns.size()];
    float number = value(row, label.number);
    if (label.minus) number -= value(row, *label.minus);
    labels[i] = number / unit;
  }
}

}  // namespace shoal::learner
