// SPDX-License-Identifier: Apache-2.0
// The frame ring: the newest `capacity` records in one mapping, each stored once, as it came.
// ring_format.h has the layout and what survives what.
//
// Threads: none inside; one owner. A second process may map the file read-only (OpenSnapshot).
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
  std::filesystem::path file;  // empty: anonymous memory, nothing survives
  uint64_t capacity = 0;       // records
  std::string run;             // stored in the file for people
  // Step records that earlier servers of the run have acknowledged. The count goes on from here
  // where the ring itself knows of fewer: it is new, or an older copy.
  uint64_t steps_before = 0;
  StartupProgress progress = {};  // called while a file that is there is read; may be empty
};

class Ring {
 public:
  // Opens the file when it is there, else makes it (under another name, renamed when complete).
  // Throws Error when there is no room, or (usage) when the file is of another spec, version or
  // capacity, truncated or damaged: then nothing of it is used and the message says what differs,
  // and what to do.
  Ring(const ObservationSpec& spec, const RingOptions& options);

  // Throws Error (usage) as the constructor would for the file's header and size, without reading
  // its records.
  static void CheckFile(const ObservationSpec& spec, const RingOptions& options);

  // Read-only view of a file that a server may be writing to. Records may vanish under the reader:
  // ask Intact() after reading them. Throws Error like the constructor.
  static Ring OpenSnapshot(const ObservationSpec& spec, const std::filesystem::path& file);

  const RecordLayout& layout() const { return layout_; }
  uint64_t capacity() const { return geometry_.capacity; }
  uint64_t bytes() const { return mapping_.size(); }

  // Ids oldest_id() .. last_id() are there; empty when last_id() < oldest_id(). last_id() is also
  // the number of records stored over the whole run.
  uint64_t oldest_id() const { return oldest_id_; }
  uint64_t last_id() const { return last_id_; }
  bool Holds(uint64_t id) const { return id >= oldest_id_ && id <= last_id_; }
  // Step records stored over the whole run, those included that went with a former ring.
  uint64_t stored_steps() const { return stored_steps_; }

  // Stores a copy of a record of layout().record_bytes() as the successor of record `prev` (0 for a
  // reset) and returns its id. Overwrites the record `capacity` ids before.
  uint64_t Append(uint32_t actor, uint64_t session, uint64_t prev, const uint8_t* record);

  // For ids that Holds(). The views borrow the mapping.
  const SlotHeader& Slot(uint64_t id) const;
  const uint8_t* Record(uint64_t id) const;
  const RecordHeader& Header(uint64_t id) const { return RecordLayout::Header(Record(id)); }
  // The slot of `id` holds it, completely written. Always so but in a snapshot.
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
