// SPDX-License-Identifier: Apache-2.0
// accounting.json of a run (schema shoal-accounting-1): how many records of each actor session were
// stored, rejected, lost or discarded. The receiver of records (the replay, or on policy the
// learner) writes the file. A restarted receiver continues the counts. The coordinator compares the
// counts with those of the actors.
//
//   {schema, stored_steps, stored_records, ring_replaced, sessions: [{actor, session, highest,
//    stored, rejected, after_gap, lost, discarded, duplicates}]}
//
// Files of earlier versions lack ring_replaced and discarded; they are then read as false and 0.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace shoal {

// Outcomes of the records of one (actor, session). The records with sequences 1..highest were
// handled. Each of them is counted once: highest = stored + rejected + after_gap + lost +
// discarded.
struct SessionCounters {
  uint32_t actor = 0;
  uint64_t session = 0;
  uint64_t highest = 0;
  uint64_t rejected = 0;    // malformed records
  uint64_t after_gap = 0;   // records whose predecessor in the episode is not stored
  uint64_t lost = 0;        // records that an earlier receiver stored and lost with its memory
  uint64_t discarded = 0;   // records of a rollout that no update used
  uint64_t duplicates = 0;  // records that arrived again; not part of the sum

  uint64_t stored() const { return highest - rejected - after_gap - lost - discarded; }
  bool operator==(const SessionCounters&) const = default;
};

// Content of the file.
struct RunAccount {
  uint64_t stored_steps = 0;
  uint64_t stored_records = 0;  // records that the receiver stored, or on policy learned from
  // Whether at some time in the run a ring was lost with its records and replaced.
  bool ring_replaced = false;
  std::vector<SessionCounters> sessions{};
};

// Reads the file of a run. Throws Error naming the file and the member if a member is missing or
// has another type, or if the counts of a session do not add up.
RunAccount ReadAccount(const std::filesystem::path& run);

// Like ReadAccount, but returns zeros if no receiver has written the file yet. Throws Error
// (kUsage).
RunAccount ReadAccountBefore(const std::filesystem::path& run);

// Replaces the file of a run atomically: readers see the old file or the new file. Does not call
// fsync, so that a busy disk does not delay the caller. Throws Error.
void ReplaceAccount(const std::filesystem::path& run, const RunAccount& account);
// Replaces the file and calls fsync. Used when the receiver ends.
void StoreAccount(const std::filesystem::path& run, const RunAccount& account);

}  // namespace shoal
