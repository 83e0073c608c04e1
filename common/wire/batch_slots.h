// SPDX-License-Identifier: Apache-2.0
// Whole batches in shared memory (common/base/shared_memory.h). The replay writes batches into
// slots, and the learner reads the batches in place. Messages report full slots (BatchSlot) and
// released slots (SampleRequest::released).
//
//   offset  bytes
//   0       8       magic "SHOALSL1"
//   8       16      token, random
//   24      8       learner session to which the slots belong
//   32      8       size of a slot in bytes
//   40      4       n, the number of slots
//   64      8 n     for each slot: the request whose whole batch is in the slot; 0 = empty
//   then    slots, each at a multiple of 4096
//
// Slots belong to one learner session, which releases the slots in the order of its requests.
// Another session gets other memory. Therefore a slot is written again only after its reader has
// released the slot. When a reader has ended, the memory with its slots is freed.
//
// If the memory cannot be made or opened, the call throws Error. Replay and learner then use
// BatchPart instead. Only one thread at a time may use an object.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/base/shared_memory.h"
#include "common/wire/messages.h"

namespace shoal {

// The replay's side. Owns the memory.
class SlotWriter {
 public:
  // Makes `slots` slots of `batch_bytes` bytes. Throws the errors of SharedMemory::Make.
  SlotWriter(uint64_t spec_hash, uint64_t learner_session, uint64_t batch_bytes, uint32_t slots);
  // Size of the memory for these slots.
  static uint64_t MemoryBytes(uint64_t batch_bytes, uint32_t slots);

  const SlotAddress& address() const { return address_; }
  // Returns the memory of a free slot: batch_bytes bytes, aligned to 4096. Returns nullptr if no
  // slot is free. The slot counts as free until Reserve() or Fill().
  uint8_t* FreeSlot();
  // Keeps the slot that FreeSlot() returned last for the batch of `request`, until Fill(). FreeSlot
  // may be called again before.
  void Reserve(uint64_t request);
  // Marks the slot that is reserved for `request` or, without such a slot, the slot that FreeSlot()
  // returned last as full: it contains the batch of `request`. No other slot may contain a batch of
  // this request. Returns the message for the learner.
  BatchSlot Fill(uint64_t request, uint64_t stored_records, uint64_t stored_steps,
                 uint64_t unsampleable_steps = 0);
  // The message that announced the slot of `request`; empty if no slot contains this batch.
  std::optional<BatchSlot> Held(uint64_t request) const;
  // Frees the full slots of requests up to `released`.
  void Release(uint64_t released);
  // Number of slots that contain a batch or are reserved for one.
  uint32_t held() const;

 private:
  struct Slot {
    uint64_t request = 0;  // 0: free
    bool full = false;     // false: free or reserved
    uint64_t stored_records = 0, stored_steps = 0, unsampleable_steps = 0;
  };
  BatchSlot Word(uint32_t slot) const;
  // The slot that contains the batch of `request` or is reserved for it.
  std::optional<uint32_t> Find(uint64_t request) const;

  const uint64_t spec_hash_, learner_session_, batch_bytes_;
  const SharedMemory memory_;
  SlotAddress address_;
  std::vector<Slot> slots_;
  std::optional<uint32_t> writing_;  // slot that FreeSlot returned last
};

// The learner's side of the slots at a BatchSlot's address. Maps the memory during its lifetime.
class SlotReader {
 public:
  // Throws Error if the memory at the address does not contain the slots of this session.
  SlotReader(const SlotAddress& address, uint64_t learner_session, uint64_t batch_bytes,
             SharedMemory::Access access = SharedMemory::Access::kRead);

  const SlotAddress& address() const { return address_; }
  // All slots.
  std::span<const uint8_t> memory() const { return {memory_.data(), memory_.bytes()}; }
  // The batch of the request; valid until the learner releases the request. Throws Error if the
  // slot contains another batch.
  uint8_t* Batch(uint32_t slot, uint64_t request) const;

 private:
  const SlotAddress address_;
  const uint64_t batch_bytes_;
  const SharedMemory memory_;
  uint32_t slots_ = 0;
};

}  // namespace shoal
