// SPDX-License-Identifier: Apache-2.0
// Accounting per actor session, kept in the ring's mapping so that it outlives the process.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/intake/session_ledger.h"
#include "replay_server/core/ring_format.h"

namespace shoal::replay {

// What an earlier server of the run left when its ring is gone.
struct FormerServer {
  uint64_t stored_steps = 0;
  std::vector<SessionCounters> sessions;
};

// An update is one step as seen by recovery.
class SessionTable final : public SessionLedger {
 public:
  // `storage` is borrowed. Sessions found there are loaded. Throws Error when one is damaged.
  explicit SessionTable(std::span<StoredSession> storage);

  // Into an empty table: the sessions of a server whose ring is gone. What it had stored is lost.
  void Inherit(const FormerServer& former);

 private:
  void OnUpdate(int i, const SessionCounters& counters) override;

  std::span<StoredSession> storage_;
  std::vector<uint64_t> versions_;
};

}  // namespace shoal::replay
