// SPDX-License-Identifier: Apache-2.0
// Chooses the samples that make up a batch, by the step that each begins with (episode_index.h).
//
// The index tells a selector what there is: each sample once when it can be drawn and once when it
// no longer can. The probabilities of its draws allow importance weights.
//
// Threads: none inside; one owner.
#pragma once

#include <cstdint>
#include <optional>

#include "common/base/random.h"

namespace shoal::replay {

struct Selection {
  uint64_t id = 0;         // of the sample's first step
  double probability = 0;  // with which one draw gives it, now
};

class Selector {
 public:
  virtual ~Selector() = default;

  // The sample that begins with step `id` can be drawn from now on; it can no longer.
  virtual void Added(uint64_t id) = 0;
  virtual void Removed(uint64_t id) = 0;

  // A sample, or nothing when none was found. `random` alone decides, given the same history.
  virtual std::optional<Selection> Draw(Random* random) = 0;
  // Draws that had to be repeated since construction.
  virtual uint64_t redraws() const = 0;
};

}  // namespace shoal::replay
