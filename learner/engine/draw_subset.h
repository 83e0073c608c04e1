// SPDX-License-Identifier: Apache-2.0
// Random subsets, for example of an ensemble of critics (Eq. 30 of docs/algorithm.md).
#pragma once

#include <cstdint>
#include <vector>

#include "common/base/random.h"

namespace shoal::learner {

// Draws `count` different numbers of 0 ... n-1, uniformly and without replacement, in the order of
// the draws. Calls random->Below `count` times. CHECKs 0 <= count <= n.
std::vector<int32_t> DrawSubset(int n, int count, Random* random);

}  // namespace shoal::learner
