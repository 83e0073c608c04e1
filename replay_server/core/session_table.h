// SPDX-License-Identifier: Apache-2.0
// Accounting per actor session, kept in the ring's mapping so that it outlives the process.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/intake/session_ledger.h"
#include "replay_server/core/ring_format.h"

namespace shoal::replay {

// State of an earlier server of the run, read from the account.
struct FormerServer {
  uint64_t stored_steps = 0;
  std::vector<SessionCounters> sessions;
};

// An update is one step as seen by recovery.
class SessionTable final : public SessionLedger {
 public:
  // `storage` is borrowed. Sessions found there are loaded. Throws Error when one is damaged.
  explicit SessionTable(std::span<StoredSession> storage);

  // Adds the counts of an earlier server that exceed those of this table: its ring is gone, or this
  // ring is an older copy. Records that the earlier server stored and this ring lacks are counted
  // as lost.
  void TakeOver(const FormerServer& former);
  // Whether an earlier server had stored records that this ring lacks.
  bool StoresLessThan(const FormerServer& former) const;

 private:
  void OnUpdate(int i, const SessionCounters& counters) override;

  std::span<StoredSession> storage_;
  std::vector<uint64_t> versions_;
};

}  // namespace shoal::replay
