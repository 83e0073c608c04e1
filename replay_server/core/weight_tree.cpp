// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/weight_tree.h"

#include <bit>

#include "common/base/check.h"

namespace shoal::replay {

void WeightTree::Set(size_t i, uint64_t weight) {
  const uint64_t change = weight - weights_[i];  // may wrap around, as the sums do
  weights_[i] = weight;
  total_ += change;
  for (size_t k = i + 1; k < sums_.size(); k += k & -k) sums_[k] += change;
}

size_t WeightTree::Find(uint64_t at) const {
  CHECK(at < total_) << at << " of " << total_;
  size_t before = 0;  // weights known to be left of the sought one
  for (size_t step = std::bit_floor(weights_.size()); step > 0; step /= 2) {
    const size_t k = before + step;
    if (k >= sums_.size() || sums_[k] > at) continue;
    before = k;
    at -= sums_[k];
  }
  return before;
}

}  // namespace shoal::replay
