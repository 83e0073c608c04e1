// SPDX-License-Identifier: Apache-2.0
// Credits of the actors: the newest session of each actor, its window, and its last sent credit.
//
//   allowed = stored + window, raised only while the limiter permits inserts, never lowered
//   allowed <= stored + share of the budget; if this bound falls, allowed is lowered to it
//
// The budget is a number of env steps, and a credit is a number of records, which include resets. A
// session that makes as many records as its share of the budget therefore makes fewer env steps
// than the share. Each session has an equal share, but at least the records for one more step and
// for its oldest chunk (`least_records`), so that the other actors can finish a run if some actors
// hang. The budget is therefore exceeded by less than `least_records` per session.
//
// Threads: starts no threads; not thread-safe, one owner.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "common/intake/session_ledger.h"
#include "common/wire/messages.h"

namespace shoal {

class CreditBook {
 public:
  // Borrows the ledger. `receiver_session`: session of the process that writes the credits.
  CreditBook(const SessionLedger& sessions, uint64_t spec_hash, uint64_t receiver_session,
             uint64_t window_records, uint64_t least_records);

  // Adds new sessions, reads the stored counts from the ledger, and raises the credits if
  // `may_insert`. `steps_left`: env steps left in the budget; empty if there is no budget.
  void Refresh(bool may_insert, std::optional<uint64_t> steps_left);
  // Returns credits of the newest sessions. `changed_only`: only credits that changed since the
  // last Take.
  std::vector<Credit> Take(bool changed_only);

  // Whether credits should be sent now, because an actor has at most half of its window left
  // according to its last sent credit, or has received no credit yet.
  bool Urgent() const;

  // Number of actor sessions that have a window.
  int sessions() const { return static_cast<int>(accounts_.size()); }
  // Whether at least one session has less credit than its window.
  bool Withholding() const;

 private:
  struct Account {
    uint64_t session = 0;
    uint64_t stored = 0, allowed = 0;
    uint64_t told_stored = 0;
    bool changed = true, told = false;
  };

  // Number of records, allowed but not yet stored, that a session may have within the budget.
  uint64_t Share(std::optional<uint64_t> steps_left) const;

  const SessionLedger& sessions_;
  const uint64_t spec_hash_, receiver_session_, window_records_, least_records_;
  std::map<uint32_t, Account> accounts_;  // by actor
};

}  // namespace shoal
