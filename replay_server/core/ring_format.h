// SPDX-License-Identifier: Apache-2.0
// The ring file, version 3. All little-endian.
//
//   RingHeader, padded to 4096 bytes
//   StoredSession[kMaxSessions]          accounting per (actor, session); two copies each
//   slots[capacity], slot_bytes each     SlotHeader | record bytes verbatim (common/spec/record.h)
//
// Record ids run from 1 without holes; record `id` is in slot id mod capacity, so the ring holds
// the newest `capacity` records.
//
// The file survives the death of the writing process at any instant, because the kernel owns its
// pages. The file does not survive a power failure: nothing is synced. The commit word covers the
// slot header, which contains the frame's check word, and the record up to its frame. A flipped bit
// anywhere in a record is therefore detected.
#pragma once

#include <cstdint>
#include <span>

#include "common/spec/record.h"

namespace shoal::replay {

inline constexpr char kRingMagic[8] = {'S', 'H', 'O', 'A', 'L', 'R', 'N', 'G'};
inline constexpr uint32_t kRingVersion = 3;
inline constexpr uint32_t kMaxSessions = 4096;
inline constexpr uint64_t kRingHeaderBytes = 4096;

struct RingHeader {
  char magic[8];
  uint32_t version;
  uint32_t max_sessions;
  uint64_t spec_hash;  // of the observation spec
  uint64_t record_bytes;
  uint64_t slot_bytes;
  uint64_t capacity;  // slots
  char run[72];       // name of the run that made it, for people; zero-terminated
  uint64_t check;     // HashBytes of everything before
};
static_assert(sizeof(RingHeader) == 128);

// One copy of a session's counters. A session is updated by writing the copy that is not the
// newest, its check word last: a writer that dies half-way leaves the other copy.
struct SessionCopy {
  uint64_t check;    // HashBytes of everything after; 0 = never written
  uint64_t version;  // grows with each update, from 1; the copy is number version mod 2
  uint64_t session;
  uint64_t actor;
  uint64_t highest;  // sequences 1..highest have been processed
  uint64_t rejected;
  uint64_t after_gap;
  uint64_t lost;
  uint64_t duplicates;
};
static_assert(sizeof(SessionCopy) == 72);

struct StoredSession {
  SessionCopy copies[2];
};

struct SlotHeader {
  uint64_t commit;   // 0 = empty or being written; else SlotCommit(), written last
  uint64_t id;       // from 1
  uint64_t prev;     // id of the predecessor in the episode; 0 for a reset
  uint64_t session;  // of the actor that made the record
  uint64_t steps;    // step records stored up to and with this one, over the whole run
  uint32_t actor;
  uint32_t reserved;
  uint64_t frame_check;  // FrameCheck of the record's frame
  uint64_t reserved_word;
};
static_assert(sizeof(SlotHeader) == 64);

// Sizes and offsets of a ring. A value type.
struct RingGeometry {
  uint64_t record_bytes = 0;
  uint64_t prefix_bytes = 0;  // of a record before its frame: covered by the commit word
  uint64_t capacity = 0;

  RingGeometry() = default;
  RingGeometry(const ObservationSpec& spec, uint64_t slots)
      : record_bytes(static_cast<uint64_t>(RecordLayout(spec).record_bytes())),
        prefix_bytes(static_cast<uint64_t>(RecordLayout(spec).prefix_bytes())),
        capacity(slots) {}

  uint64_t slot_bytes() const { return (sizeof(SlotHeader) + record_bytes + 63) / 64 * 64; }
  uint64_t slots_offset() const {
    return (kRingHeaderBytes + kMaxSessions * sizeof(StoredSession) + 4095) / 4096 * 4096;
  }
  uint64_t total_bytes() const { return slots_offset() + capacity * slot_bytes(); }
};

// The frame of a stored record.
inline std::span<const uint8_t> FrameOf(const RingGeometry& geometry, const uint8_t* record) {
  return {record + geometry.prefix_bytes, geometry.record_bytes - geometry.prefix_bytes};
}

// The commit word of a slot: never 0.
uint64_t SlotCommit(const RingGeometry& geometry, const SlotHeader& slot, const uint8_t* record);

// Fills magic, version, sizes and check.
RingHeader MakeRingHeader(const RingGeometry& geometry, uint64_t spec_hash, const char* run);

}  // namespace shoal::replay
