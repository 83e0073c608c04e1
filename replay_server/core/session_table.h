// SPDX-License-Identifier: Apache-2.0
// Counts of stored, rejected and lost records for each actor session. The table is in the ring's
// mapping, so that the counts survive the death of the process.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/intake/session_ledger.h"
#include "replay_server/core/ring_format.h"

namespace shoal::replay {

// Counts of an earlier server of the run, read from accounting.json.
struct FormerServer {
  uint64_t stored_steps = 0;
  std::vector<SessionCounters> sessions;
};

// Updates are atomic: if the process dies during an update, the table has the old or the new
// counts.
class SessionTable final : public SessionLedger {
 public:
  // Borrows `storage` and loads the sessions in it. Throws Error if a session is damaged.
  explicit SessionTable(std::span<StoredSession> storage);

  // If counts of an earlier server are higher than those of this table, adopts the higher counts.
  // The reason: the earlier server's ring was lost, or this ring is an older copy. Records that the
  // earlier server stored and that are missing in this ring are counted as lost.
  void TakeOver(const FormerServer& former);
  // Whether an earlier server stored records that are missing in this ring.
  bool StoresLessThan(const FormerServer& former) const;

 private:
  void OnUpdate(int i, const SessionCounters& counters) override;

  std::span<StoredSession> storage_;
  std::vector<uint64_t> versions_;
};

}  // namespace shoal::replay
