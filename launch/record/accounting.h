// SPDX-License-Identifier: Apache-2.0
// Where every record went: what the actors made against what the replay dealt with.
//
//   made = stored + lost_with_process + lost_with_replay + rejected + after_gap + discarded,
//   exactly;
//   duplicates and resends are apart. Sequences of a session run 1 .. made; the replay dealt with 1
//   .. highest of them. lost_with_process is what an actor's death kept from the replay, made -
//   highest; lost_with_replay was stored and is gone: in the memory of a replay server that died,
//   or with a replay file that was removed. While the file is there, there is none such: it is a
//   fault. A run without a replay stores nothing: there `stored` are the records that updates were
//   made of, `discarded` the others that the learner took, of rollouts that were not finished or
//   not used; nothing is ever discarded by a replay. What the sessions say is stored is held
//   against the ring's own count.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "common/run_folder/accounting_file.h"

namespace shoal::launch {

// One actor session, by its own count (actor/sending/sequence_log.h).
struct MadeRecords {
  uint32_t actor = 0;
  uint64_t session = 0;
  uint64_t made = 0;
  bool known = true;  // false: the page was lost, and `made` is what the replay had seen
};

struct Accounting {
  uint64_t made = 0, stored = 0, lost_with_process = 0, lost_with_replay = 0;
  uint64_t rejected = 0, after_gap = 0, discarded = 0;
  uint64_t duplicates = 0, resends = 0;
  // Of actors started by hand, on a host that cannot be reached any more, or whose page was lost:
  // what the replay saw counts as made, what they made beyond it is unknown.
  uint64_t sessions_without_page = 0;
  std::vector<std::string> faults;  // one line for each thing that does not balance

  bool Balances() const { return faults.empty(); }
  // "made 120 = stored 117 + lost with a process 2 + lost with a replay 1 + rejected 0 + after a
  // gap 0 + discarded 0; ..."
  std::string Line() const;
};

struct AccountTerms {
  uint64_t resends = 0;
  uint32_t own_actors = 0;      // sessions of actors below must have a page
  bool outlives_replay = true;  // what is stored is in a file
};

// `seen`: by the replay's count, or by the learner's in a run without one; each session's counts
// add up (ReadAccount).
Accounting Account(std::span<const MadeRecords> made, const RunAccount& seen,
                   const AccountTerms& terms);

nlohmann::ordered_json ToJson(const Accounting& accounting);

}  // namespace shoal::launch
