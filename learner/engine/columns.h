// SPDX-License-Identifier: Apache-2.0
// Columns of the vectors of a batch: joined, split, or gathered as labels.
// Dimensions: b rows, L labels.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "common/spec/observation_spec.h"

namespace shoal::learner {

// One label of a row: a number of the observed or the privileged vector, minus another such number
// if there is one.
struct LabelColumns {
  struct Column {
    bool observed;  // else privileged
    size_t at;
  };
  Column number;
  std::optional<Column> minus;
};

// joined[b] = [ left[b] | the columns `ranges` of right[b] ]
void JoinColumns(size_t rows, std::span<const float> left, std::span<const float> right,
                 std::span<const ObservationSpec::Range> ranges, std::span<float> joined);

// Splits the columns of joined[b] = [ left[b] | right[b] ].
void SplitColumns(size_t rows, std::span<const float> joined, std::span<float> left,
                  std::span<float> right);

// labels[b, l] = (number - minus) / unit
void GatherLabels(size_t rows, std::span<const float> observed, std::span<const float> privileged,
                  std::span<const LabelColumns> columns, float unit, std::span<float> labels);

}  // namespace shoal::learner
