// SPDX-License-Identifier: Apache-2.0
// Chooses the samples of a batch. A sample is named by its first step (episode_index.h).
//
// The index reports each sample once when it can be drawn, and once when it can no longer be drawn.
// The probabilities of the draws allow importance weights.
//
// Threads: none inside; one owner.
#pragma once

#include <cstdint>
#include <optional>

#include "common/base/random.h"

namespace shoal::replay {

struct Selection {
  uint64_t id = 0;         // of the sample's first step
  double probability = 0;  // of one draw, at present
};

class Selector {
 public:
  virtual ~Selector() = default;

  // Added: the sample that begins with step `id` can be drawn from now on. Removed: the sample can
  // no longer be drawn.
  virtual void Added(uint64_t id) = 0;
  virtual void Removed(uint64_t id) = 0;

  // Draws a sample; empty if none was found. Given the same history, the draw depends on `random`
  // alone.
  virtual std::optional<Selection> Draw(Random* random) = 0;
  // Draws that had to be repeated since construction.
  virtual uint64_t redraws() const = 0;
};

}  // namespace shoal::replay
