// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/ring_recovery.h"

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "common/base/error.h"
#include "common/base/random.h"
#include "replay_server/core/frame_check.h"

namespace shoal::replay {
namespace {

const SlotHeader& SlotAt(const Mapping& mapping, const RingGeometry& geometry, uint64_t slot) {
  return *reinterpret_cast<const SlotHeader*>(mapping.data() + geometry.slots_offset() +
                                              slot * geometry.slot_bytes());
}

// Only an unused slot, or the slot that was being written, may lack a complete record.
Error Damaged(const std::string& name, uint64_t slot, const std::string& what) {
  return RuntimeError("replay file '{}' is damaged: slot {} {}", name, slot, what);
}

uint64_t NewestId(const Mapping& mapping, const RingGeometry& geometry,
                  const StartupProgress& progress = {}) {
  uint64_t newest = 0;
  for (uint64_t slot = 0; slot < geometry.capacity; ++slot) {
    const SlotHeader& header = SlotAt(mapping, geometry, slot);
    if (header.commit != 0) newest = std::max(newest, header.id);
    if (progress) progress();
  }
  return newest;
}

}  // namespace

uint64_t CheckRingHeader(const Mapping& mapping, const ObservationSpec& spec,
                         const std::string& name) {
  RingHeader header;
  if (mapping.size() < sizeof(header)) {
    throw RuntimeError("replay file '{}' is truncated: {} bytes", name, mapping.size());
  }
  std::memcpy(&header, mapping.data(), sizeof(header));
  if (std::memcmp(header.magic, kRingMagic, sizeof(kRingMagic)) != 0) {
    throw RuntimeError("'{}' is not a replay file", name);
  }
  if (header.version != kRingVersion) {
    throw RuntimeError("replay file '{}' has version {}, this program reads version {}", name,
                       header.version, kRingVersion);
  }
  if (header.check != HashBytes(&header, offsetof(RingHeader, check))) {
    throw RuntimeError("replay file '{}' is damaged: its header's check does not fit", name);
  }
  if (header.spec_hash != spec.Hash()) {
    throw RuntimeError(
        "replay file '{}' holds observations of spec {:016x}, this run has {:016x} ({})", name,
        header.spec_hash, spec.Hash(), spec.Summary());
  }
  const RingGeometry geometry(spec, header.capacity);
  if (header.record_bytes != geometry.record_bytes || header.slot_bytes != geometry.slot_bytes() ||
      header.max_sessions != kMaxSessions || header.capacity == 0) {
    throw RuntimeError("replay file '{}' has records of {} bytes, expected {}", name,
                       header.record_bytes, geometry.record_bytes);
  }
  if (mapping.size() != geometry.total_bytes()) {
    throw RuntimeError("replay file '{}' has {} bytes, its header tells of {}: truncated?", name,
                       mapping.size(), geometry.total_bytes());
  }
  return header.capacity;
}

bool SlotIntact(const Mapping& mapping, const RingGeometry& geometry, uint64_t slot) {
  const SlotHeader& header = SlotAt(mapping, geometry, slot);
  const auto* record = reinterpret_cast<const uint8_t*>(&header + 1);
  return header.commit != 0 && header.commit == SlotCommit(geometry, header, record) &&
         header.frame_check == FrameCheck(FrameOf(geometry, record));
}

RingExtent ScanRing(const Mapping& mapping, const RingGeometry& geometry, const std::string& name,
                    const StartupProgress& progress) {
  const uint64_t capacity = geometry.capacity;
  const uint64_t last = NewestId(mapping, geometry, progress);
  RingExtent extent;
  extent.last_id = last;
  extent.oldest_id = last > capacity ? last - capacity + 1 : 1;
  for (uint64_t slot = 0; slot < capacity; ++slot) {
    if (progress) progress();
    const SlotHeader& header = SlotAt(mapping, geometry, slot);
    // The only id that this slot may hold: the newest one that is not above `last`.
    const uint64_t behind = (last % capacity + capacity - slot) % capacity;
    const uint64_t expected = last > behind ? last - behind : 0;
    if (header.commit == 0) {
      const bool unused = expected == 0;
      const bool being_overwritten = slot == (last + 1) % capacity;
      if (!unused && !being_overwritten) throw Damaged(name, slot, "is empty");
      if (!unused) extent.oldest_id = expected + 1;
      continue;
    }
    if (header.id != expected) {
      throw Damaged(name, slot, fmt::format("holds record {}, expected {}", header.id, expected));
    }
    if (!SlotIntact(mapping, geometry, slot)) throw Damaged(name, slot, "fails its check");
  }
  if (last > 0) extent.stored_steps = SlotAt(mapping, geometry, last % capacity).steps;
  return extent;
}

RingExtent ScanLiveRing(const Mapping& mapping, const RingGeometry& geometry) {
  RingExtent extent;
  extent.last_id = NewestId(mapping, geometry);
  if (extent.last_id >= geometry.capacity) {
    // Leaves out the eighth of the ring that the writer overwrites next.
    extent.oldest_id = extent.last_id - geometry.capacity + 1 + (geometry.capacity + 7) / 8;
  }
  extent.stored_steps = SlotAt(mapping, geometry, extent.last_id % geometry.capacity).steps;
  return extent;
}

}  // namespace shoal::replay
