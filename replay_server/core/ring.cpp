// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/ring.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <functional>

#include "common/base/check.h"
#include "common/base/error.h"
#include "replay_server/core/frame_check.h"
#include "replay_server/core/ring_recovery.h"

namespace shoal::replay {
namespace {

namespace fs = std::filesystem;

// Makes a new, empty ring. The file gets its name when it is complete, so a process killed here
// leaves no file that its successor has to refuse.
Mapping MakeRing(const ObservationSpec& spec, const RingOptions& options) {
  const RingGeometry geometry(spec, options.capacity);
  const RingHeader header = MakeRingHeader(geometry, spec.Hash(), options.run.c_str());
  if (options.file.empty()) {
    Mapping mapping = Mapping::Anonymous(geometry.total_bytes());
    std::memcpy(mapping.data(), &header, sizeof(header));
    return mapping;
  }
  const fs::path unfinished = options.file.string() + ".new";
  Mapping mapping = Mapping::NewFile(unfinished, geometry.total_bytes());
  std::memcpy(mapping.data(), &header, sizeof(header));
  std::error_code error;
  fs::rename(unfinished, options.file, error);
  if (error) {
    throw RuntimeError("cannot name the replay file '{}': {}", options.file.string(),
                       error.message());
  }
  return mapping;
}

bool Exists(const fs::path& file) {
  std::error_code error;
  const bool there = !file.empty() && fs::exists(file, error);
  if (error) throw RuntimeError("cannot look for '{}': {}", file.string(), error.message());
  return there;
}

void CheckHeader(const Mapping& mapping, const ObservationSpec& spec, const RingOptions& options) {
  const std::string name = options.file.string();
  const uint64_t capacity = CheckRingHeader(mapping, spec, name);
  if (capacity != options.capacity) {
    throw RuntimeError("replay file '{}' has room for {} records, replay.capacity is {}", name,
                       capacity, options.capacity);
  }
}

// Adds the remedy to an error, because another start with the same file would fail again.
void WithRemedy(const std::function<void()>& read) {
  try {
    read();
  } catch (const Error& e) {
    throw UsageError("{}; {}", e.what(), kRingRemedy);
  }
}

std::atomic_ref<uint64_t> CommitWord(SlotHeader* slot) {
  return std::atomic_ref<uint64_t>(slot->commit);
}

}  // namespace

Ring::Ring(const ObservationSpec& spec, uint64_t capacity, Mapping mapping)
    : layout_(spec), geometry_(spec, capacity), mapping_(std::move(mapping)) {}

Ring::Ring(const ObservationSpec& spec, const RingOptions& options)
    : layout_(spec), geometry_(spec, options.capacity) {
  CHECK(options.capacity > 0);
  if (!Exists(options.file)) {
    mapping_ = MakeRing(spec, options);
    stored_steps_ = options.steps_before;
    return;
  }
  mapping_ = Mapping::OpenFile(options.file, Access::kReadWrite);
  WithRemedy([&] {
    CheckHeader(mapping_, spec, options);
    const RingExtent extent =
        ScanRing(mapping_, geometry_, options.file.string(), options.progress);
    oldest_id_ = extent.oldest_id;
    last_id_ = extent.last_id;
    stored_steps_ = std::max(extent.stored_steps, options.steps_before);
  });
}

void Ring::CheckFile(const ObservationSpec& spec, const RingOptions& options) {
  WithRemedy(
      [&] { CheckHeader(Mapping::OpenFile(options.file, Access::kReadOnly), spec, options); });
}

Ring Ring::OpenSnapshot(const ObservationSpec& spec, const fs::path& file) {
  Mapping mapping = Mapping::OpenFile(file, Access::kReadOnly);
  const uint64_t capacity = CheckRingHeader(mapping, spec, file.string());
  Ring ring(spec, capacity, std::move(mapping));
  const RingExtent extent = ScanLiveRing(ring.mapping_, ring.geometry_);
  ring.oldest_id_ = extent.oldest_id;
  ring.last_id_ = extent.last_id;
  ring.stored_steps_ = extent.stored_steps;
  return ring;
}

uint8_t* Ring::SlotData(uint64_t id) const {
  return mapping_.data() + geometry_.slots_offset() +
         id % geometry_.capacity * geometry_.slot_bytes();
}

uint64_t Ring::Append(uint32_t actor, uint64_t session, uint64_t prev, const uint8_t* record) {
  const uint64_t id = last_id_ + 1;
  CHECK(prev < id);
  const bool is_step = RecordLayout::Header(record).kind == RecordKind::kStep;
  auto* slot = reinterpret_cast<SlotHeader*>(SlotData(id));
  // The slot has no record from here until the commit word is set. The process may be killed
  // between any two stores, so the fence keeps the compiler from reordering them.
  CommitWord(slot).store(0, std::memory_order_relaxed);
  std::atomic_signal_fence(std::memory_order_seq_cst);
  if (id > geometry_.capacity) oldest_id_ = std::max(oldest_id_, id - geometry_.capacity + 1);
  slot->id = id;
  slot->prev = prev;
  slot->session = session;
  slot->steps = stored_steps_ + (is_step ? 1 : 0);
  slot->actor = actor;
  slot->reserved = 0;
  slot->frame_check = FrameCheck(FrameOf(geometry_, record));
  slot->reserved_word = 0;
  auto* stored = reinterpret_cast<uint8_t*>(slot + 1);
  std::memcpy(stored, record, geometry_.record_bytes);
  CommitWord(slot).store(SlotCommit(geometry_, *slot, stored), std::memory_order_release);
  stored_steps_ = slot->steps;
  last_id_ = id;
  return id;
}

const SlotHeader& Ring::Slot(uint64_t id) const {
  CHECK(Holds(id)) << "record " << id << " is not among " << oldest_id_ << ".." << last_id_;
  return *reinterpret_cast<const SlotHeader*>(SlotData(id));
}

const uint8_t* Ring::Record(uint64_t id) const {
  return reinterpret_cast<const uint8_t*>(&Slot(id) + 1);
}

bool Ring::Intact(uint64_t id) const {
  return Slot(id).id == id && SlotIntact(mapping_, geometry_, id % geometry_.capacity);
}

std::span<StoredSession> Ring::sessions() const {
  return {reinterpret_cast<StoredSession*>(mapping_.data() + kRingHeaderBytes), kMaxSessions};
}

}  // namespace shoal::replay
