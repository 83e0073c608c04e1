// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/weight_tree.h"

#include <gtest/gtest.h>

#include "common/base/random.h"

namespace shoal::replay {
namespace {

// Index of the weight that contains `at` in the sequence of weights.
size_t Sought(const std::vector<uint64_t>& weights, uint64_t at) {
  size_t i = 0;
  while (at >= weights[i]) at -= weights[i++];
  return i;
}

// Sizes near powers of two; weights that are added, changed and removed, many of them 0.
TEST(WeightTree, FindsWhatAWalkOverAllWeightsFinds) {
  Random random(1);
  for (const size_t size : {1, 2, 3, 8, 13, 64, 65}) {
    WeightTree tree(size);
    std::vector<uint64_t> weights(size);
    for (int change = 0; change < 300; ++change) {
      const size_t i = random.Below(size);
      weights[i] = random.Below(3) == 0 ? 0 : random.Below(1'000'000);
      tree.Set(i, weights[i]);
      uint64_t total = 0;
      for (const uint64_t weight : weights) total += weight;
      ASSERT_EQ(tree.total(), total);
      ASSERT_EQ(tree.Get(i), weights[i]);
      if (total == 0) continue;
      for (const uint64_t at : {uint64_t{0}, random.Below(total), total - 1}) {
        ASSERT_EQ(tree.Find(at), Sought(weights, at)) << at << " of " << total << ", size " << size;
      }
    }
  }
}

}  // namespace
}  // namespace shoal::replay
