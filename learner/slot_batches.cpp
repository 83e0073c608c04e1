// SPDX-License-Identifier: Apache-2.0
#include "learner/slot_batches.h"

#include <algorithm>

namespace shoal::learner {

SlotBatches::Verdict SlotBatches::Add(const BatchSlot& slot) {
  if (slot.address.token[0] == refused_token_) return Verdict::kRefused;
  const auto [known, is_new] = words_.try_emplace(slot.request, slot);
  if (is_new) return Verdict::kTaken;
  if (known->second.address == slot.address && known->second.slot == slot.slot) {
    return Verdict::kDuplicate;
  }
  known->second = slot;
  return Verdict::kStartedOver;
}

// Memory that may only be read cannot be pinned on every system.
SlotBatches::Memory::Memory(const BatchSlot& word, uint64_t learner_session, uint64_t batch_bytes,
                            const PinMemory& pin)
    : reader(word.address, learner_session, batch_bytes,
             pin ? SharedMemory::Access::kReadAndWrite : SharedMemory::Access::kRead),
      pinned(pin ? pin(reader.memory()) : nullptr) {}

uint8_t* SlotBatches::Open(uint64_t request) {
  const BatchSlot& word = words_.at(request);
  const auto known = std::ranges::find_if(
      memories_, [&](const Memory& mapped) { return mapped.reader.address() == word.address; });
  const Memory& memory = known != memories_.end()
                             ? *known
                             : memories_.emplace_back(word, learner_session_, batch_bytes_, pin_);
  return memory.reader.Batch(word.slot, request);
}

std::vector<uint64_t> SlotBatches::Refuse(uint64_t request) {
  const SlotAddress address = words_.at(request).address;
  refused_token_ = address.token[0];
  std::vector<uint64_t> requests;
  std::erase_if(words_, [&](const auto& word) {
    if (word.second.address != address) return false;
    requests.push_back(word.first);
    return true;
  });
  Forget();
  return requests;
}

void SlotBatches::Release(uint64_t request) {
  if (words_.erase(request) > 0) Forget();
}

void SlotBatches::Forget() {
  const Memory* newest = memories_.empty() ? nullptr : &memories_.back();
  std::erase_if(memories_, [&](const Memory& memory) {
    return &memory != newest && std::ranges::none_of(words_, [&](const auto& word) {
      return word.second.address == memory.reader.address();
    });
  });
}

}  // namespace shoal::learner
