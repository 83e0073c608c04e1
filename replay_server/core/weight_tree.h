// SPDX-License-Identifier: Apache-2.0
// Weights by number, one of which can be drawn in proportion to its weight: a Fenwick tree (Fenwick
// 1994, "A new data structure for cumulative frequency tables"). Whole numbers, so that sums are
// exact and do not depend on the order in which weights came and went.
//
// Threads: none inside; one owner. Memory: 16 bytes per weight. Setting and finding: log2(size).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace shoal::replay {

class WeightTree {
 public:
  // All 0.
  explicit WeightTree(size_t size) : weights_(size), sums_(size + 1) {}

  static constexpr uint64_t Bytes(uint64_t size) { return (2 * size + 1) * sizeof(uint64_t); }

  void Set(size_t i, uint64_t weight);
  uint64_t Get(size_t i) const { return weights_[i]; }
  uint64_t total() const { return total_; }
  // The i in whose part `at` lies when the weights are laid one after the other; at < total().
  size_t Find(uint64_t at) const;

 private:
  std::vector<uint64_t> weights_;
  std::vector<uint64_t> sums_;  // [k]: of the weights k - (lowest bit of k) .. k - 1
  uint64_t total_ = 0;
};

}  // namespace shoal::replay
