// SPDX-License-Identifier: Apache-2.0
#include "common/wire/batch_slots.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstring>
#include <span>
#include <utility>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/random_bytes.h"

namespace shoal {
namespace {

constexpr uint64_t kPage = 4096;
constexpr uint64_t kMagic = 0x314c534c414f4853;  // "SHOALSL1"
constexpr uint32_t kMostSlots = 4096;

struct Header {
  uint64_t magic;
  uint64_t token[2];
  uint64_t learner_session;
  uint64_t slot_bytes;  // of a batch, without the padding to the next page
  uint32_t slots;
};
constexpr uint64_t kWordsAt = 64;
static_assert(std::endian::native == std::endian::little);
static_assert(offsetof(Header, slots) == 40 && sizeof(Header) <= kWordsAt);

constexpr uint64_t Pages(uint64_t bytes) { return (bytes + kPage - 1) / kPage * kPage; }
uint64_t SlotOffset(uint64_t batch_bytes, uint32_t slots, uint32_t slot) {
  return Pages(kWordsAt + uint64_t{8} * slots) + slot * Pages(batch_bytes);
}

// Both sides access the word as an atomic. A reader that finds a request in the word sees the whole
// batch.
std::atomic_ref<uint64_t> RequestWord(const SharedMemory& memory, uint32_t slot) {
  static_assert(std::atomic_ref<uint64_t>::is_always_lock_free);
  return std::atomic_ref<uint64_t>(reinterpret_cast<uint64_t*>(memory.data() + kWordsAt)[slot]);
}

void DrawToken(uint64_t (&token)[2]) {
  FillWithRandomBytes(std::as_writable_bytes(std::span(token)));
  token[0] |= 1;  // 0 means none
}

}  // namespace

uint64_t SlotWriter::MemoryBytes(uint64_t batch_bytes, uint32_t slots) {
  return SlotOffset(batch_bytes, slots, slots);
}

SlotWriter::SlotWriter(uint64_t spec_hash, uint64_t learner_session, uint64_t batch_bytes,
                       uint32_t slots)
    : spec_hash_(spec_hash),
      learner_session_(learner_session),
      batch_bytes_(batch_bytes),
      memory_(SharedMemory::Make("shoal-batches", MemoryBytes(batch_bytes, slots))),
      slots_(slots) {
  CHECK(batch_bytes > 0 && slots > 0 && slots <= kMostSlots) << batch_bytes << " x " << slots;
  address_ = {.pid = getpid(), .descriptor = memory_.descriptor(), .bytes = memory_.bytes()};
  DrawToken(address_.token);
  const Header header{.magic = kMagic,
                      .token = {address_.token[0], address_.token[1]},
                      .learner_session = learner_session,
                      .slot_bytes = batch_bytes,
                      .slots = slots};
  std::memcpy(memory_.data(), &header, sizeof header);
}

uint8_t* SlotWriter::FreeSlot() {
  const auto free = std::ranges::find(slots_, 0u, &Slot::request);
  if (free == slots_.end()) return nullptr;
  writing_ = static_cast<uint32_t>(free - slots_.begin());
  // A reader must not take the slot for its former batch while the slot is rewritten.
  RequestWord(memory_, *writing_).store(0, std::memory_order_release);
  return memory_.data() + SlotOffset(batch_bytes_, static_cast<uint32_t>(slots_.size()), *writing_);
}

void SlotWriter::Reserve(uint64_t request) {
  CHECK(writing_ && request > 0 && !Find(request)) << request;
  slots_[*writing_] = {.request = request};
  writing_.reset();
}

std::optional<uint32_t> SlotWriter::Find(uint64_t request) const {
  const auto found = std::ranges::find(slots_, request, &Slot::request);
  if (request == 0 || found == slots_.end()) return std::nullopt;
  return static_cast<uint32_t>(found - slots_.begin());
}

BatchSlot SlotWriter::Fill(uint64_t request, uint64_t stored_records, uint64_t stored_steps,
                           uint64_t unsampleable_steps) {
  const std::optional<uint32_t> reserved = Find(request);
  CHECK((reserved || writing_) && request > 0 && !Held(request)) << request;
  const uint32_t slot = reserved ? *reserved : *std::exchange(writing_, std::nullopt);
  slots_[slot] = {request, /*full=*/true, stored_records, stored_steps, unsampleable_steps};
  RequestWord(memory_, slot).store(request, std::memory_order_release);
  return Word(slot);
}

std::optional<BatchSlot> SlotWriter::Held(uint64_t request) const {
  const std::optional<uint32_t> slot = Find(request);
  if (!slot || !slots_[*slot].full) return std::nullopt;
  return Word(*slot);
}

void SlotWriter::Release(uint64_t released) {
  for (Slot& slot : slots_) {
    if (slot.full && slot.request <= released) slot = {};
  }
}

uint32_t SlotWriter::held() const {
  return static_cast<uint32_t>(slots_.size()) -
         static_cast<uint32_t>(std::ranges::count(slots_, 0u, &Slot::request));
}

BatchSlot SlotWriter::Word(uint32_t slot) const {
  return {.spec_hash = spec_hash_,
          .learner_session = learner_session_,
          .request = slots_[slot].request,
          .stored_records = slots_[slot].stored_records,
          .stored_steps = slots_[slot].stored_steps,
          .unsampleable_steps = slots_[slot].unsampleable_steps,
          .address = address_,
          .slot = slot};
}

SlotReader::SlotReader(const SlotAddress& address, uint64_t learner_session, uint64_t batch_bytes,
                       SharedMemory::Access access)
    : address_(address),
      batch_bytes_(batch_bytes),
      memory_(SharedMemory::Open(address.pid, address.descriptor, address.bytes, access)) {
  Header header{};
  if (address.bytes >= sizeof header) std::memcpy(&header, memory_.data(), sizeof header);
  if (header.magic != kMagic || header.token[0] != address.token[0] ||
      header.token[1] != address.token[1]) {
    throw RuntimeError("the shared memory of process {} is not the replay's", address.pid);
  }
  if (header.learner_session != learner_session || header.slot_bytes != batch_bytes ||
      header.slots > kMostSlots ||
      SlotWriter::MemoryBytes(batch_bytes, header.slots) != address.bytes) {
    throw RuntimeError(
        "the shared memory of process {} has {} slots of {} bytes for session {}; expected batches "
        "of {} bytes for session {}",
        address.pid, header.slots, header.slot_bytes, header.learner_session, batch_bytes,
        learner_session);
  }
  slots_ = header.slots;
}

uint8_t* SlotReader::Batch(uint32_t slot, uint64_t request) const {
  if (slot >= slots_ || RequestWord(memory_, slot).load(std::memory_order_acquire) != request) {
    throw RuntimeError("slot {} of {} does not hold the batch of request {}", slot, slots_,
                       request);
  }
  return memory_.data() + SlotOffset(batch_bytes_, slots_, slot);
}

}  // namespace shoal
