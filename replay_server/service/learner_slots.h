// SPDX-License-Identifier: Apache-2.0
// The shared memory in which the present learner session gets its batches: none where the learner
// takes none, could not open it, or there is no room; its batches then go over the network. Which
// it is, and why, is logged once per session.
//
// Threads: none inside; the service thread's.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "common/wire/batch_slots.h"
#include "common/wire/messages.h"
#include "replay_server/core/storage_limits.h"

namespace shoal::replay {

class LearnerSlots {
 public:
  // `slots`: what a learner may have asked for and hold at once. `room`: AvailableMemory, or a
  // fake.
  LearnerSlots(
      uint64_t spec_hash, uint64_t batch_bytes, uint32_t slots,
      std::function<MemoryRoom()> room = [] { return AvailableMemory(); });

  // A request of the session that is being answered, or of a newer one; each time it comes.
  void OnRequest(const SampleRequest& request);
  // nullptr: batches go over the network.
  SlotWriter* writer() { return writer_ ? &*writer_ : nullptr; }
  uint32_t held() const { return writer_ ? writer_->held() : 0; }

 private:
  void Begin(const SampleRequest& request);
  void Make();

  const uint64_t spec_hash_, batch_bytes_;
  const uint32_t slots_;
  const std::function<MemoryRoom()> room_;
  uint64_t session_ = 0;
  std::optional<SlotWriter> writer_;
};

}  // namespace shoal::replay
