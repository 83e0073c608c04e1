// SPDX-License-Identifier: Apache-2.0
// The drawn batches whose frames are being copied. Meanwhile the service thread stores records and
// draws further batches.
//
// The service thread calls all functions; GatherThreads copy.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "replay_server/core/replay_core.h"
#include "replay_server/service/gather_threads.h"

namespace shoal::replay {

class BatchesInWork {
 public:
  // Borrows the threads. The memory of the batches and of the ring must exist until the copies are
  // made or the threads are gone.
  explicit BatchesInWork(GatherThreads* threads) : threads_(*threads) {}

  void Add(BegunBatch batch);
  bool empty() const { return batches_.empty(); }
  bool Has(uint64_t request) const;
  // Removes the batches whose frames are all copied, and returns them in the order of Add.
  std::vector<DrawnBatch> TakeComplete();
  // Completes all batches.
  void Finish();
  // Completes the batches that copy a record with an id up to `last`.
  void FinishReadersUpTo(uint64_t last);

 private:
  struct Copied {
    DrawnBatch batch;
    uint64_t oldest;  // lowest id of the copied records; 0 = none
    uint64_t job;
  };

  GatherThreads& threads_;
  std::deque<Copied> batches_;
};

}  // namespace shoal::replay
