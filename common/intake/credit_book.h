// SPDX-License-Identifier: Apache-2.0
// Credits of the actors: the newest session of each actor, its window, and the credit last sent.
//
//   allowed = stored + window, raised while the limiter permits inserts, never lowered by it
//   allowed <= stored + share of the budget, and lowered to this bound
//
// The budget counts env steps, and a credit counts records, which include resets. A share of the
// budget, used as a number of records, therefore cannot overspend the budget. Each session has an
// equal share, but at least the records for one more step and for its oldest chunk, so that the
// other actors can finish a run if some actors hang. Hence a budget is overspent by less than
// `least_records` per session.
//
// Threads: starts none; not thread-safe, one owner.
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

  // Adds new sessions, takes the stored counts from the ledger, and raises windows if `may_insert`.
  // `steps_left`: env steps left in the budget; empty if there is no budget.
  void Refresh(bool may_insert, std::optional<uint64_t> steps_left);
  // Credits of the newest sessions. `changed_only`: only credits that changed since the last Take.
  std::vector<Credit> Take(bool changed_only);

  // Whether credits should be sent now: an actor has at most half of its window left by the credit
  // last sent, or has received no credit yet.
  bool Urgent() const;

  // Actor sessions with a window.
  int sessions() const { return static_cast<int>(accounts_.size()); }
  // Whether some session has less than its window.
  bool Withholding() const;

 private:
  struct Account {
    uint64_t session = 0;
    uint64_t stored = 0, allowed = 0;
    uint64_t told_stored = 0;
    bool changed = true, told = false;
  };

  // Records of a session that may be allowed and not yet stored, within the budget.
  uint64_t Share(std::optional<uint64_t> steps_left) const;

  const SessionLedger& sessions_;
  const uint64_t spec_hash_, receiver_session_, window_records_, least_records_;
  std::map<uint32_t, Account> accounts_;  // by actor
};

}  // namespace shoal
