// SPDX-License-Identifier: Apache-2.0
// Batches in the replay's shared memory: maps each request id to the slot that holds its batch, and
// the slots' memory into this process. Memory of a replay that has ended stays readable while a
// batch in it is awaited or handed out.
//
// Threads: none inside; one owner.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "common/wire/batch_slots.h"
#include "common/wire/messages.h"

namespace shoal::learner {

class SlotBatches {
 public:
  enum class Verdict {
    kTaken,
    kStartedOver,  // taken in place of another answer to the request
    kDuplicate,    // said before
    kRefused,      // in memory that was refused
  };

  SlotBatches(uint64_t learner_session, uint64_t batch_bytes)
      : learner_session_(learner_session), batch_bytes_(batch_bytes) {}

  // A word of this session, for a request whose batch is waited for.
  Verdict Add(const BatchSlot& slot);
  bool Has(uint64_t request) const { return words_.contains(request); }
  uint64_t stored_records(uint64_t request) const { return words_.at(request).stored_records; }
  uint64_t stored_steps(uint64_t request) const { return words_.at(request).stored_steps; }
  uint64_t unsampleable_steps(uint64_t request) const {
    return words_.at(request).unsampleable_steps;
  }

  // The batch of a request that it has; to be read, until Release. Opens the memory when it is
  // needed first. Throws Error when that cannot be or the slot does not hold the batch.
  uint8_t* Open(uint64_t request);
  // After that: no batch is taken from this memory any more. The requests that had one there, to be
  // sent again.
  std::vector<uint64_t> Refuse(uint64_t request);
  // SlotAddress::token[0] of what was refused last; 0 = nothing.
  uint64_t refused_token() const { return refused_token_; }

  // The batch, if there is one, is not read any more.
  void Release(uint64_t request);

 private:
  // Unmaps what no word means any more but the newest.
  void Forget();

  const uint64_t learner_session_, batch_bytes_;
  std::map<uint64_t, BatchSlot> words_;  // by request
  std::vector<std::unique_ptr<SlotReader>> memories_;
  uint64_t refused_token_ = 0;
};

}  // namespace shoal::learner
