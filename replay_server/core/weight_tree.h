// SPDX-License-Identifier: Apache-2.0
// Draws an index in proportion to its weight: a Fenwick tree (Fenwick 1994, "A new data structure
// for cumulative frequency tables"). Weights are whole numbers, so that sums are exact and do not
// depend on the order of changes.
//
// Starts no threads; not thread-safe, one owner. Memory: 16 bytes per weight. Cost of Set and Find:
// log2(size) steps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace shoal::replay {

class WeightTree {
 public:
  // All weights are 0.
  explicit WeightTree(size_t size) : weights_(size), sums_(size + 1) {}

  static constexpr uint64_t Bytes(uint64_t size) { return (2 * size + 1) * sizeof(uint64_t); }

  void Set(size_t i, uint64_t weight);
  uint64_t Get(size_t i) const { return weights_[i]; }
  uint64_t total() const { return total_; }
  // The smallest i for which the sum of the weights 0 .. i is greater than `at`. Requires at <
  // total().
  size_t Find(uint64_t at) const;

 private:
  std::vector<uint64_t> weights_;
  std::vector<uint64_t> sums_;  // sums_[k]: sum of the weights k - (lowest bit of k) .. k - 1
  uint64_t total_ = 0;
};

}  // namespace shoal::replay
