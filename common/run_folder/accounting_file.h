// SPDX-License-Identifier: Apache-2.0
// accounting.json of a run (schema shoal-accounting-1): outcomes of all records, per actor session.
// The receiver of records, replay or learner, writes the file. The receiver's successor continues
// the counts, and the coordinator compares them with the counts of the actors.
//
//   {schema, stored_steps, stored_records, ring_replaced, sessions: [{actor, session, highest,
//    stored, rejected, after_gap, lost, discarded, duplicates}]}
//
// Files of earlier versions lack ring_replaced and discarded, which are then false and 0.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace shoal {

// Outcomes of the records of one (actor, session). Sequences 1..highest were handled; each is
// counted once:  highest = stored + rejected + after_gap + lost + discarded.
struct SessionCounters {
  uint32_t actor = 0;
  uint64_t session = 0;
  uint64_t highest = 0;
  uint64_t rejected = 0;    // malformed
  uint64_t after_gap = 0;   // records whose predecessor in the episode is not stored
  uint64_t lost = 0;        // stored by an earlier receiver that lost its memory
  uint64_t discarded = 0;   // records of a rollout that no update used
  uint64_t duplicates = 0;  // received again; not part of the sum

  uint64_t stored() const { return highest - rejected - after_gap - lost - discarded; }
  bool operator==(const SessionCounters&) const = default;
};

struct RunAccount {
  uint64_t stored_steps = 0;
  uint64_t stored_records = 0;  // the receiver's own count of records ever stored, or learned from
  // Whether at some time in the run a ring was lost with its records and replaced.
  bool ring_replaced = false;
  std::vector<SessionCounters> sessions{};
};

// Reads the file of a run. Throws Error naming the file and the member if a member is missing or
// has another type, or if the counts of a session do not add up.
RunAccount ReadAccount(const std::filesystem::path& run);

// Reads the file as ReadAccount does; returns zeros if no receiver has written the file yet. Throws
// Error (usage).
RunAccount ReadAccountBefore(const std::filesystem::path& run);

// Replaces the file of a run: readers see the old file or the new file. The file is not synced, so
// that a busy disk does not delay the caller. Throws Error.
void ReplaceAccount(const std::filesystem::path& run, const RunAccount& account);
// Replaces the file for the last time: the file is on the disk when the function returns.
void StoreAccount(const std::filesystem::path& run, const RunAccount& account);

}  // namespace shoal
