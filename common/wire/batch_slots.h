// SPDX-License-Identifier: Apache-2.0
// Whole batches in shared memory (common/base/shared_memory.h). The replay writes batches into
// slots, and the learner reads the batches in place. Messages report full slots (BatchSlot) and
// released slots (SampleRequest::released).
//
//   offset  bytes
//   0       8       magic "SHOALSL1"
//   8       16      token, random
//   24      8       learner session that the slots are for
//   32      8       bytes of a slot
//   40      4       slots, n
//   64      8 n     per slot: the request whose whole batch is in the slot; 0 = none
//   then    slots, each at a multiple of 4096
//
// Slots belong to one learner session, which releases them in the order of its requests. Another
// session gets other memory. A slot is therefore written again only after its reader has released
// it. When a reader has ended, its slots are freed with the memory.
//
// Errors: if the memory cannot be made or opened, the call throws Error, and both sides fall back
// to BatchPart.
// Threads: one at a time per object.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/shared_memory.h"
#include "common/wire/messages.h"

namespace shoal {

// The replay's side. Owns the memory.
class SlotWriter {
 public:
  // `slots` batches of `batch_bytes`. Throws Error: SharedMemory::Make.
  SlotWriter(uint64_t spec_hash, uint64_t learner_session, uint64_t batch_bytes, uint32_t slots);
  static uint64_t MemoryBytes(uint64_t batch_bytes, uint32_t slots);

  const SlotAddress& address() const { return address_; }
  // Memory of a free slot: batch_bytes, aligned to 4096. Returns nullptr while all slots hold
  // batches. The slot counts as free until Fill().
  uint8_t* FreeSlot();
  // Marks the slot that FreeSlot() returned last as full with the batch of `request`, which must
  // not be held yet. Returns the message for the learner.
  BatchSlot Fill(uint64_t request, uint64_t stored_records, uint64_t stored_steps,
                 uint64_t unsampleable_steps = 0);
  // The message that announced the slot of `request`, if the slot is held.
  std::optional<BatchSlot> Held(uint64_t request) const;
  // Frees the slots of requests up to `released`.
  void Release(uint64_t released);
  // Number of slots that hold a batch.
  uint32_t held() const;

 private:
  struct Slot {
    uint64_t request = 0;  // 0: free
    uint64_t stored_records = 0, stored_steps = 0, unsampleable_steps = 0;
  };
  BatchSlot Word(uint32_t slot) const;

  const uint64_t spec_hash_, learner_session_, batch_bytes_;
  const SharedMemory memory_;
  SlotAddress address_;
  std::vector<Slot> slots_;
  std::optional<uint32_t> writing_;  // handed out by FreeSlot
};

// The learner's side of the slots at a BatchSlot's address. Maps the memory during its lifetime.
class SlotReader {
 public:
  // Throws Error when the memory at the address does not hold the slots of this session.
  SlotReader(const SlotAddress& address, uint64_t learner_session, uint64_t batch_bytes);

  const SlotAddress& address() const { return address_; }
  // The batch of the request; valid until the learner releases the request. Throws Error when the
  // slot holds another batch.
  uint8_t* Batch(uint32_t slot, uint64_t request) const;

 private:
  const SlotAddress address_;
  const uint64_t batch_bytes_;
  const SharedMemory memory_;
  uint32_t slots_ = 0;
};

}  // namespace shoal
