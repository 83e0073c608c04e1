// SPDX-License-Identifier: Apache-2.0
// Batches in the replay's shared memory. Finds the slot of each request id, and maps the memory of
// the slots into this process. If a replay has ended, its memory stays mapped as long as it
// contains a batch that is awaited or in use.
//
// Starts no threads; not thread-safe, one owner.
#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/wire/batch_slots.h"
#include "common/wire/messages.h"
#include "learner/pin_memory.h"

namespace shoal::learner {

class SlotBatches {
 public:
  enum class Verdict {
    kTaken,
    kStartedOver,  // replaced an earlier answer to the request
    kDuplicate,    // ignored: the same message arrived before
    kRefused,      // ignored: the slot is in refused memory
  };

  SlotBatches(uint64_t learner_session, uint64_t batch_bytes, PinMemory pin = {})
      : learner_session_(learner_session), batch_bytes_(batch_bytes), pin_(std::move(pin)) {}

  // Adds a slot message of this session, for a request whose batch is awaited.
  Verdict Add(const BatchSlot& slot);
  bool Has(uint64_t request) const { return words_.contains(request); }
  uint64_t stored_records(uint64_t request) const { return words_.at(request).stored_records; }
  uint64_t stored_steps(uint64_t request) const { return words_.at(request).stored_steps; }
  uint64_t unsampleable_steps(uint64_t request) const {
    return words_.at(request).unsampleable_steps;
  }

  // Returns the batch of a request whose slot is known. The batch may be read until Release. Maps
  // the memory at its first use. Throws Error if the memory cannot be mapped or if the slot does
  // not contain the batch.
  uint8_t* Open(uint64_t request);
  // Refuses the memory that contains the batch of `request`: from now on no batch is read from this
  // memory. Returns the requests whose batches were in this memory; they must be sent again.
  std::vector<uint64_t> Refuse(uint64_t request);
  // SlotAddress::token[0] of the memory that was refused last; 0 if no memory was refused.
  uint64_t refused_token() const { return refused_token_; }

  // Ends the use of the request's batch, if there is one.
  void Release(uint64_t request);

 private:
  // The mapped slots of a replay. Not movable: an assignment would replace the reader first, and a
  // pin must end before its memory.
  struct Memory {
    Memory(const BatchSlot& word, uint64_t learner_session, uint64_t batch_bytes,
           const PinMemory& pin);
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;

    const SlotReader reader;
    const std::shared_ptr<const void> pinned;  // destroyed before the reader
  };

  // Unmaps each memory to which no slot message refers, except the newest memory.
  void Forget();

  const uint64_t learner_session_, batch_bytes_;
  std::map<uint64_t, BatchSlot> words_;  // by request
  const PinMemory pin_;
  std::list<Memory> memories_;
  uint64_t refused_token_ = 0;
};

}  // namespace shoal::learner
