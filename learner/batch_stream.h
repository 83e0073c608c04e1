// SPDX-License-Identifier: Apache-2.0
// Source of the training loop's batches.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/clock.h"
#include "common/wire/batch_schema.h"

namespace shoal::learner {

struct Batch {
  // Valid until the next call of the stream's Next. Read-only, because the memory may be shared
  // with the replay.
  BatchView view;
  uint64_t request = 0;  // id of the answered request
  // Records that were stored over the whole run when the batch was drawn; the steps are in `view`.
  uint64_t stored_records = 0;
  uint64_t unsampleable_steps = 0;  // see BatchPart; 0 on policy
};

// Errors of the values of a batch's samples, at least 0. An id may occur twice.
struct SampleErrors {
  uint64_t request = 0;  // of the batch
  std::vector<uint64_t> ids{};
  std::vector<float> errors{};
};

// Counters of pending requests, of faults so far, and of repeated requests.
struct BatchCounters {
  uint64_t requests_outstanding = 0;  // requests whose batches Next has not returned yet
  uint64_t ready = 0;                 // outstanding requests whose batches are complete
  uint64_t resent_requests = 0;
  std::optional<bool> shared{};  // whether the last batch is in shared memory
  // "Parts" below are parts and slot messages.
  uint64_t duplicate_parts = 0;
  uint64_t unknown_parts = 0;    // parts of finished requests or of earlier learner sessions
  uint64_t malformed_parts = 0;  // parts with sizes or offsets that no batch has
  uint64_t refused_slots = 0;    // slots that cannot be mapped or do not contain the batch
  uint64_t dropped_answers = 0;  // answers that were replaced by another answer

  // Counters of a stream of rollouts. Such a stream does not use the counters above.
  struct Rollouts {
    // Environments for whose rollouts the next update waits, and environments that have a rollout.
    uint64_t expected = 0, ready = 0;
    uint64_t late = 0;     // environments missing in updates
    uint64_t dropped = 0;  // rollouts that no update used
    uint64_t records = 0;  // records that were received and valid
    uint64_t rejected = 0, after_gap = 0, lost = 0, duplicates = 0;
    uint64_t refused_chunks = 0, pool_drops = 0;
    uint64_t actor_sessions = 0;
  };
  std::optional<Rollouts> rollouts{};
};

class BatchStream {
 public:
  virtual ~BatchStream() = default;

  // Waits until `deadline` for the next batch in the order of request ids. If no batch arrives,
  // Next returns empty and no batch is lost. Throws Error if the sender has another observation
  // spec.
  virtual std::optional<Batch> Next(SteadyTime deadline) = 0;
  virtual BatchCounters counters() const = 0;
  // Prioritised sampling: takes the errors of an earlier batch, in the order of requests.
  virtual void TakeErrors(const SampleErrors& /*errors*/) {}
  // Sets the current number of the run's actors. Some streams depend on this number.
  virtual void SetActors(int /*actors*/) {}
};

}  // namespace shoal::learner
