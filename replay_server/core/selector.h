// SPDX-License-Identifier: Apache-2.0
// Chooses the samples of a batch. The id of a sample is that of its first step (episode_index.h).
//
// The episode index reports each sample to the selector when the sample becomes available, and
// again when it becomes unavailable. The probability of a draw can be used for importance weights.
//
// Starts no threads; not thread-safe, one owner.
#pragma once

#include <cstdint>
#include <optional>

#include "common/base/random.h"

namespace shoal::replay {

struct Selection {
  uint64_t id = 0;         // id of the sample's first step
  double probability = 0;  // probability of this sample in one draw
};

class Selector {
 public:
  virtual ~Selector() = default;

  // Added: called when the sample that begins with step `id` becomes available. Removed: called
  // when the sample becomes unavailable.
  virtual void Added(uint64_t id) = 0;
  virtual void Removed(uint64_t id) = 0;

  // Draws a sample; empty if no sample was found. After the same calls of Added, Removed and
  // SetError, the result depends only on `random`.
  virtual std::optional<Selection> Draw(Random* random) = 0;
  // Sets the priority of a sample from the error of its value, which is finite and at least 0.
  // Returns false if the sample is not available, or if the selector has no priorities.
  virtual bool SetError(uint64_t /*id*/, float /*error*/) { return false; }
  // The largest priority so far; 0 without priorities.
  virtual double largest_priority() const { return 0; }
  // Number of repeated draws since construction.
  virtual uint64_t redraws() const = 0;
};

}  // namespace shoal::replay
