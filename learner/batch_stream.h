// SPDX-License-Identifier: Apache-2.0
// Source of the training loop's batches.
#pragma once

#include <cstdint>
#include <optional>

#include "common/base/clock.h"
#include "common/wire/batch_schema.h"

namespace shoal::learner {

struct Batch {
  // Valid until the stream's Next is called again. Read-only: it may be in the replay's memory.
  BatchView view;
  uint64_t request = 0;             // id of the answered request
  uint64_t stored_records = 0;      // in the replay at the draw, whole run; for steps see view
  uint64_t unsampleable_steps = 0;  // see BatchPart; 0 on policy
};

// Counters of pending requests, of faults so far, and of the repeats that corrected them.
struct BatchCounters {
  uint64_t requests_outstanding = 0;  // batches requested and not handed out yet
  uint64_t ready = 0;                 // complete ones among them
  uint64_t resent_requests = 0;
  std::optional<bool> shared{};  // whether the last batch is in shared memory
  uint64_t duplicate_parts = 0;  // here and below: parts and slot messages
  uint64_t unknown_parts = 0;    // of finished requests or earlier learner sessions
  uint64_t malformed_parts = 0;  // with sizes or offsets that no batch has
  uint64_t refused_slots = 0;    // not mappable, or without the batch
  uint64_t dropped_answers = 0;  // replaced by another answer

  // Counters of a stream of rollouts, which has none of the above.
  struct Rollouts {
    uint64_t expected = 0, ready = 0;  // environments: awaited; with a rollout
    uint64_t late = 0;                 // environments missing in updates
    uint64_t dropped = 0;              // rollouts that no update used
    uint64_t records = 0;              // taken
    uint64_t rejected = 0, after_gap = 0, lost = 0, duplicates = 0;
    uint64_t refused_chunks = 0, pool_drops = 0;
    uint64_t actor_sessions = 0;
  };
  std::optional<Rollouts> rollouts{};
};

class BatchStream {
 public:
  virtual ~BatchStream() = default;

  // Waits until `deadline` for the next batch in the order of request ids. If it returns none, no
  // batch is lost; call it again. Throws Error if the sender has another observation spec.
  virtual std::optional<Batch> Next(SteadyTime deadline) = 0;
  virtual BatchCounters counters() const = 0;
  // Sets the current number of the run's actors, for streams that depend on it.
  virtual void SetActors(int /*actors*/) {}
};

}  // namespace shoal::learner
