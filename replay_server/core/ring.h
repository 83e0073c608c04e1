// SPDX-License-Identifier: Apache-2.0
// The ring buffer of records: the newest `capacity` records in one mapping. Each record is stored
// once and does not change. ring_format.h describes the layout, and the failures that a ring
// survives.
//
// Starts no threads; not thread-safe, one owner. A second process may map the file read-only
// (OpenSnapshot).
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "common/spec/observation_spec.h"
#include "replay_server/core/mapping.h"
#include "replay_server/core/ring_format.h"
#include "replay_server/core/startup_progress.h"

namespace shoal::replay {

struct RingOptions {
  std::filesystem::path file;  // empty: anonymous memory, lost with the process
  uint64_t capacity = 0;       // records
  std::string run;             // stored in the file for people
  // Step records that earlier servers of the run have acknowledged. If the ring's own count is
  // lower, because the ring is new or an older copy, counting continues from this number.
  uint64_t steps_before = 0;
  StartupProgress progress = {};  // called while an existing file is read; may be empty
};

class Ring {
 public:
  // Opens the file. If the file does not exist, makes it under a temporary name and renames it when
  // it is complete. Throws Error if there is not enough space. Throws Error (kUsage) if the file
  // has another spec, version or capacity, or is truncated or damaged; the message contains the
  // difference and the remedy. No part of such a file is used.
  Ring(const ObservationSpec& spec, const RingOptions& options);

  // Checks the header and the size of the file without reading its records. Throws the same Error
  // (kUsage) as the constructor.
  static void CheckFile(const ObservationSpec& spec, const RingOptions& options);

  // Read-only view of a file to which a server may be writing. The server may overwrite a record
  // while it is read: call Intact() after reading a record. Throws Error like the constructor.
  static Ring OpenSnapshot(const ObservationSpec& spec, const std::filesystem::path& file);

  const RecordLayout& layout() const { return layout_; }
  uint64_t capacity() const { return geometry_.capacity; }
  uint64_t bytes() const { return mapping_.size(); }

  // The ring contains the ids oldest_id() .. last_id(); it is empty if last_id() < oldest_id().
  // last_id() is also the number of records stored over the whole run.
  uint64_t oldest_id() const { return oldest_id_; }
  uint64_t last_id() const { return last_id_; }
  bool Holds(uint64_t id) const { return id >= oldest_id_ && id <= last_id_; }
  // Number of step records stored over the whole run, including those in an earlier ring that was
  // lost.
  uint64_t stored_steps() const { return stored_steps_; }

  // Stores a copy of a record of layout().record_bytes() bytes and returns its id. `prev`: the
  // predecessor in the episode; 0 for the episode's first record. If the ring is full, overwrites
  // the oldest record.
  uint64_t Append(uint32_t actor, uint64_t session, uint64_t prev, const uint8_t* record);

  // The next three functions require Holds(id). The returned views borrow the mapping.
  const SlotHeader& Slot(uint64_t id) const;
  const uint8_t* Record(uint64_t id) const;
  const RecordHeader& Header(uint64_t id) const { return RecordLayout::Header(Record(id)); }
  // Whether the slot of record `id` contains this record completely. Can be false only in a
  // snapshot.
  bool Intact(uint64_t id) const;

  std::span<StoredSession> sessions() const;

 private:
  Ring(const ObservationSpec& spec, uint64_t capacity, Mapping mapping);
  uint8_t* SlotData(uint64_t id) const;

  RecordLayout layout_;
  RingGeometry geometry_;
  Mapping mapping_;
  uint64_t oldest_id_ = 1, last_id_ = 0, stored_steps_ = 0;
};

}  // namespace shoal::replay
