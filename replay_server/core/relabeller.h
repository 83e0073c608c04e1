// SPDX-License-Identifier: Apache-2.0
// Gives samples other goals: hindsight.h. What another goal changes is goal_change.h.
#pragma once

#include <cstdint>

#include "common/base/random.h"

namespace shoal::replay {

class Relabeller {
 public:
  virtual ~Relabeller() = default;
  // The record of the same episode whose achieved goal the sample that begins with step `id` is
  // given, or 0: it keeps its own. `random` alone decides, given the same ring.
  virtual uint64_t DrawGoal(uint64_t id, Random* random) = 0;
};

}  // namespace shoal::replay
