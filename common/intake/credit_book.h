// SPDX-License-Identifier: Apache-2.0
// Credits of the actors: the newest session of each actor, its window, and the credit last sent.
//
//   allowed = stored + window, raised while inserts may go on, never lowered by the limiter
//   allowed <= stored + share of the budget, and lowered for it
//
// The budget is one of env steps, a credit one of records, resets among them: a share of so many
// records cannot overspend it. Each session has an equal share, but not less than it needs to make
// one more step and to send its oldest chunk, so that the others end a run without those who hang;
// hence a budget is overspent by less than `least_records` per session.
//
// Threads: none inside; one owner.
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
  // Borrows the ledger. `receiver_session`: of the process that writes the credits.
  CreditBook(const SessionLedger& sessions, uint64_t spec_hash, uint64_t receiver_session,
             uint64_t window_records, uint64_t least_records);

  // Takes over new sessions and newly dealt-with records; raises windows if `may_insert`.
  // `steps_left`: of the budget; empty where there is none.
  void Refresh(bool may_insert, std::optional<uint64_t> steps_left);
  // Credits of newest sessions; `changed_only`: those that differ from what was taken last.
  std::vector<Credit> Take(bool changed_only);

  // Whether credits should be sent now: an actor has at most half of its window left by the credit
  // last sent, or has received no credit yet.
  bool Urgent() const;

  // Actor sessions with a window.
  int sessions() const { return static_cast<int>(accounts_.size()); }
  // Some session has less than its window.
  bool Withholding() const;

 private:
  struct Account {
    uint64_t session = 0;
    uint64_t stored = 0, allowed = 0;
    uint64_t told_stored = 0;
    bool changed = true, told = false;
  };

  // Records that a session may have allowed and not stored, for the budget's sake.
  uint64_t Share(std::optional<uint64_t> steps_left) const;

  const SessionLedger& sessions_;
  const uint64_t spec_hash_, receiver_session_, window_records_, least_records_;
  std::map<uint32_t, Account> accounts_;  // by actor
};

}  // namespace shoal
