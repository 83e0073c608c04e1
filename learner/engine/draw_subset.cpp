// SPDX-License-Identifier: Apache-2.0
#include "learner/engine/draw_subset.h"

#include <numeric>
#include <utility>

#include "common/base/check.h"

namespace shoal::learner {

// The first steps of Fisher and Yates's shuffle.
std::vector<int32_t> DrawSubset(int n, int count, Random* random) {
  CHECK(0 <= count && count <= n) << count << " of " << n;
  auto numbers = std::vector<int32_t>(size_t(n));
  std::iota(numbers.begin(), numbers.end(), 0);
  for (int i = 0; i < count; ++i) {
    std::swap(numbers[size_t(i)], numbers[size_t(i) + random->Below(uint64_t(n - i))]);
  }
  numbers.resize(size_t(count));
  return numbers;
}

}  // namespace shoal::learner
