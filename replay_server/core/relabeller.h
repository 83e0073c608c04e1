// SPDX-License-Identifier: Apache-2.0
// Chooses new goals for samples (hindsight.h). goal_change.h computes the relabelled transition.
#pragma once

#include <cstdint>

#include "common/base/random.h"

namespace shoal::replay {

class Relabeller {
 public:
  virtual ~Relabeller() = default;
  // Chooses the new goal of the sample that begins with step `id`. Returns the record of the same
  // episode whose achieved goal is the new goal, or 0 if the sample keeps its goal. For the same
  // ring, the choice depends only on `random`.
  virtual uint64_t DrawGoal(uint64_t id, Random* random) = 0;
};

}  // namespace shoal::replay
