// SPDX-License-Identifier: Apache-2.0
// Gives samples other goals (hindsight.h). goal_change.h computes the relabelled transition.
#pragma once

#include <cstdint>

#include "common/base/random.h"

namespace shoal::replay {

class Relabeller {
 public:
  virtual ~Relabeller() = default;
  // Chooses the new goal of the sample that begins with step `id`: returns the record of the same
  // episode whose achieved goal becomes the goal, or 0 if the sample keeps its goal. Given the same
  // ring, the choice depends on `random` alone.
  virtual uint64_t DrawGoal(uint64_t id, Random* random) = 0;
};

}  // namespace shoal::replay
