// SPDX-License-Identifier: Apache-2.0
// The ring file, version 3. All numbers are little-endian.
//
//   RingHeader, padded to 4096 bytes
//   StoredSession[kMaxSessions]          counters of each (actor, session), in two copies
//   slots[capacity], slot_bytes each     SlotHeader | unchanged record (common/spec/record.h)
//
// Record ids begin at 1, without gaps. Record `id` is in slot id mod capacity, so the ring contains
// the newest `capacity` records.
//
// The file survives the death of the writing process at any time, because the kernel owns the
// pages. The file does not survive a power failure, because fsync is never called. The commit word
// is a check word of the slot header and of the record up to its frame. The slot header contains
// the frame's check word. A flipped bit anywhere in a record is therefore detected.
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
  uint64_t spec_hash;  // hash of the observation spec
  uint64_t record_bytes;
  uint64_t slot_bytes;
  uint64_t capacity;  // slots
  char run[72];       // name of the run that made the file, for people; zero-terminated
  uint64_t check;     // HashBytes of all bytes before
};
static_assert(sizeof(RingHeader) == 128);

// One copy of a session's counters. An update writes the older of the two copies, and writes the
// check word last. If the writer dies during the update, the other copy stays valid.
struct SessionCopy {
  uint64_t check;    // HashBytes of all bytes after; 0 = never written
  uint64_t version;  // number of the update, from 1; the update writes copy number version mod 2
  uint64_t session;
  uint64_t actor;
  uint64_t highest;  // sequences 1..highest have been handled
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
  uint64_t session;  // session of the actor that made the record
  uint64_t steps;    // number of step records of the whole run, up to and including this record
  uint32_t actor;
  uint32_t reserved;
  uint64_t frame_check;  // FrameCheck of the record's frame
  uint64_t reserved_word;
};
static_assert(sizeof(SlotHeader) == 64);

// Sizes and offsets of a ring. A value type.
struct RingGeometry {
  uint64_t record_bytes = 0;
  uint64_t prefix_bytes = 0;  // bytes of a record before its frame
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

// The commit word of a slot. It is never 0.
uint64_t SlotCommit(const RingGeometry& geometry, const SlotHeader& slot, const uint8_t* record);

// Makes a header with all its fields, including the check word.
RingHeader MakeRingHeader(const RingGeometry& geometry, uint64_t spec_hash, const char* run);

}  // namespace shoal::replay
