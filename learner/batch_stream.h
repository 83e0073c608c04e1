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
  uint64_t request = 0;             // that it answers
  uint64_t stored_records = 0;      // in the replay when it was drawn, whole run; the steps: view
  uint64_t unsampleable_steps = 0;  // as in BatchPart; on policy none
};

// Counters of pending requests, of faults so far, and of the repeats that corrected them.
struct BatchCounters {
  uint64_t requests_outstanding = 0;  // batches asked for and not handed out, now
  uint64_t ready = 0;                 // of these whole, waiting to be used
  uint64_t resent_requests = 0;
  std::optional<bool> shared{};  // whether the last batch is in shared memory
  uint64_t duplicate_parts = 0;  // these and the next: parts, and words of slots
  uint64_t unknown_parts = 0;    // of requests done with, or of a former learner session
  uint64_t malformed_parts = 0;  // sizes or offsets no batch has
  uint64_t refused_slots = 0;    // not to be opened, or without their batch
  uint64_t dropped_answers = 0;  // overtaken by another answer

  // In place of all of these, of a stream of rollouts.
  struct Rollouts {
    uint64_t expected = 0, ready = 0;  // environments the next update waits for; with a rollout
    uint64_t late = 0;                 // that updates were made without
    uint64_t dropped = 0;              // begun or whole, that no update was made of
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

  // The next batch in the order of request ids, waiting until `deadline`; none: nothing is lost,
  // ask again. Throws Error when the sender's observation spec is another one.
  virtual std::optional<Batch> Next(SteadyTime deadline) = 0;
  virtual BatchCounters counters() const = 0;
  // How many actors the run has now, where that matters.
  virtual void SetActors(int /*actors*/) {}
};

}  // namespace shoal::learner
