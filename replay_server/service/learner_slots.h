// SPDX-License-Identifier: Apache-2.0
// Shared memory in which the present learner session receives its batches. Batches are sent over
// the network if the learner does not accept slots, if it could not open the memory, or if there is
// not enough memory. The choice and its reason are logged once for each session.
//
// Starts no threads; used by the service thread.
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
  // `slots`: largest number of batches that a learner may have requested or use at one time.
  // `room`: AvailableMemory, or a fake in tests.
  LearnerSlots(
      uint64_t spec_hash, uint64_t batch_bytes, uint32_t slots,
      std::function<MemoryRoom()> room = [] { return AvailableMemory(); });

  // Call this function for every request of the present learner session or of a newer session,
  // including repeated requests.
  void OnRequest(const SampleRequest& request);
  // Whether OnRequest(request) would give up the slots of the present writer.
  bool GivesUp(const SampleRequest& request) const;
  // The writer of the slots; nullptr if batches are sent over the network.
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
