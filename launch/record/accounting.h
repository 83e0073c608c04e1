// SPDX-License-Identifier: Apache-2.0
// Account of all records: compares the records that the actors made with the records that the
// replay handled.
//
//   made = stored + lost_with_process + lost_with_replay + rejected + after_gap + discarded,
//   exactly;
//   duplicates and resends are counted separately. Sequences of a session are 1 .. made; the replay
//   handled the sequences 1 .. highest.
//   - lost_with_process: records that never reached the replay because their actor died:
//     made - highest.
//   - lost_with_replay: records that were stored and then lost, because a replay server in memory
//     died or a replay file was removed. If the file exists, such a loss is a fault.
//   - stored, without a replay: records that updates used.
//   - discarded: only without a replay. Records of rollouts that were not finished or not used.
//   The sessions' count of stored records is compared with the ring's own count.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "common/run_folder/accounting_file.h"

namespace shoal::launch {

// Number of records of one actor session, counted by the actor (actor/sending/sequence_log.h).
struct MadeRecords {
  uint32_t actor = 0;
  uint64_t session = 0;
  uint64_t made = 0;
  bool known = true;  // false: the sequence log was lost; `made` is the replay's count
};

struct Accounting {
  uint64_t made = 0, stored = 0, lost_with_process = 0, lost_with_replay = 0;
  uint64_t rejected = 0, after_gap = 0, discarded = 0;
  uint64_t duplicates = 0, resends = 0;
  // Number of sessions without a sequence log (page): actors started by hand, actors on a host that
  // cannot be reached, and lost files. The records that the replay received count as made; the
  // number of further records is unknown.
  uint64_t sessions_without_page = 0;
  std::vector<std::string> faults;  // one line for each imbalance

  bool Balances() const { return faults.empty(); }
  // "made 120 = stored 117 + lost with a process 2 + lost with a replay 1 + rejected 0 + after a
  // gap 0 + discarded 0; ..."
  std::string Line() const;
};

struct AccountTerms {
  uint64_t resends = 0;
  uint32_t own_actors = 0;      // sessions of actors below this number must have a sequence log
  bool outlives_replay = true;  // stored records are in a file
};

// `seen`: the replay's count, or the learner's count in a run without a replay. ReadAccount has
// checked that the counts of each session add up.
Accounting Account(std::span<const MadeRecords> made, const RunAccount& seen,
                   const AccountTerms& terms);

nlohmann::ordered_json ToJson(const Accounting& accounting);

}  // namespace shoal::launch
