// Where every record went: what the actors made against what the replay dealt with.
//
//   made = stored + lost_with_process + rejected + after_gap, exactly; duplicates and resends are
//   apart. Sequences of a session run 1 .. made; the replay dealt with 1 .. highest of them.
//   lost_with_process is what an actor's death kept from the replay, made - highest, and what the
//   replay counts as lost, such as the memory of one that was killed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

namespace shoal::launch {

// One actor session, by its own count (actor/made_page.h).
struct MadeRecords {
  uint32_t actor = 0;
  uint64_t session = 0;
  uint64_t made = 0;
};

// The same by the replay's count.
struct SeenRecords {
  uint32_t actor = 0;
  uint64_t session = 0;
  uint64_t highest = 0;  // sequences 1..highest were dealt with
  uint64_t stored = 0, rejected = 0, after_gap = 0, lost = 0, duplicates = 0;
};

struct Accounting {
  uint64_t made = 0, stored = 0, lost_with_process = 0, rejected = 0, after_gap = 0;
  uint64_t duplicates = 0, resends = 0;
  // Of actors started by hand, or on a host that cannot be reached any more: what the replay saw
  // counts as made, what they made beyond it is unknown.
  uint64_t sessions_without_page = 0;
  std::vector<std::string> faults;  // one line per session that does not balance

  bool Balances() const { return faults.empty(); }
  // "made 120 = stored 118 + lost with a process 2 + rejected 0 + after a gap 0; ..."
  std::string Line() const;
};

// Sessions of actors below `own_actors` must have a page; without one they are a fault.
Accounting Account(std::span<const MadeRecords> made, std::span<const SeenRecords> seen,
                   uint64_t resends, uint32_t own_actors);

// accounting.json of a run (shoal-accounting-1), written by the replay. Throws Error.
std::vector<SeenRecords> ReadSeenRecords(const std::filesystem::path& run);

nlohmann::ordered_json ToJson(const Accounting& accounting);

}  // namespace shoal::launch
