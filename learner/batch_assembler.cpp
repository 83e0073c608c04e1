// SPDX-License-Identifier: Apache-2.0
#include "learner/batch_assembler.h"

#include <algorithm>
#include <cstring>

#include "common/base/check.h"

namespace shoal::learner {
namespace {

// Bounds the memory that a malformed part count can claim. Batches have tens of parts.
constexpr uint32_t kMaxParts = 65'536;

}  // namespace

BatchAssembler::BatchAssembler(uint64_t spec_hash, uint64_t learner_session, uint64_t batch_bytes,
                               int buffers)
    : spec_hash_(spec_hash),
      learner_session_(learner_session),
      batch_bytes_(batch_bytes),
      slots_(static_cast<size_t>(buffers)) {
  CHECK(batch_bytes > 0 && batch_bytes % AlignedBytes::kAlignment == 0) << batch_bytes;
  for (Slot& slot : slots_) slot.memory = AlignedBytes(batch_bytes);
}

bool BatchAssembler::Expect(uint64_t request) {
  CHECK(request > 0 && Find(request) == nullptr) << request;
  Slot* slot = Find(0);
  if (slot == nullptr) return false;
  slot->request = request;
  slot->whole = false;
  slot->pieces.clear();
  slot->missing = 0;
  return true;
}

BatchAssembler::Verdict BatchAssembler::Add(const BatchPart& part) {
  if (part.spec_hash != spec_hash_) return Verdict::kWrongSpec;
  if (part.learner_session != learner_session_) return Verdict::kStaleSession;
  Slot* slot = part.request == 0 ? nullptr : Find(part.request);
  if (slot == nullptr) return Verdict::kUnknownRequest;
  if (!WellFormed(part)) return Verdict::kMalformed;
  if (slot->whole) return Verdict::kDuplicate;

  const bool empty = slot->pieces.empty();
  const bool same_answer = !empty && slot->pieces.size() == part.parts &&
                           slot->stored_records == part.stored_records &&
                           slot->stored_steps == part.stored_steps;
  if (!same_answer) {
    slot->stored_records = part.stored_records;
    slot->stored_steps = part.stored_steps;
    slot->unsampleable_steps = part.unsampleable_steps;
    slot->pieces.assign(part.parts, Piece());
    slot->missing = part.parts;
  }
  Piece& piece = slot->pieces[part.part];
  if (piece.bytes > 0) return Verdict::kDuplicate;
  std::memcpy(slot->memory.data() + part.offset, part.payload.data(), part.payload.size());
  piece = {part.offset, part.payload.size()};
  if (--slot->missing == 0) {
    slot->whole = Tiled(*slot);
    if (slot->whole) return Verdict::kCompleted;
    slot->pieces.clear();  // the request will be sent again
    return Verdict::kMalformed;
  }
  return same_answer || empty ? Verdict::kTaken : Verdict::kStartedOver;
}

void BatchAssembler::StartOver(uint64_t request) {
  Slot* slot = Find(request);
  CHECK(slot != nullptr) << request;
  if (!slot->whole) slot->pieces.clear();
}

std::optional<BatchAssembler::Assembled> BatchAssembler::TryGet(uint64_t request) {
  Slot* slot = Find(request);
  CHECK(slot != nullptr) << request;
  if (!slot->whole) return std::nullopt;
  return Assembled{slot->memory.data(), slot->stored_records, slot->stored_steps,
                   slot->unsampleable_steps};
}

void BatchAssembler::Release(uint64_t request) {
  Slot* slot = Find(request);
  CHECK(slot != nullptr) << request;
  slot->request = 0;
}

BatchAssembler::Slot* BatchAssembler::Find(uint64_t request) {
  const auto slot = std::ranges::find(slots_, request, &Slot::request);
  return slot == slots_.end() ? nullptr : &*slot;
}

bool BatchAssembler::WellFormed(const BatchPart& part) const {
  const uint64_t bytes = part.payload.size();
  return part.total_bytes == batch_bytes_ && part.parts > 0 && part.parts <= kMaxParts &&
         part.part < part.parts && bytes > 0 && part.offset <= batch_bytes_ &&
         bytes <= batch_bytes_ - part.offset;
}

bool BatchAssembler::Tiled(const Slot& slot) const {
  uint64_t end = 0;
  for (const Piece& piece : slot.pieces) {
    if (piece.offset != end) return false;
    end += piece.bytes;
  }
  return end == batch_bytes_;
}

}  // namespace shoal::learner
