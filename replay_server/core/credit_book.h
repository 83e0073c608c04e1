// What each actor may send: the newest session of every actor, its window, and what was last said
// about it.
//
//   allowed = stored + window, raised while inserts may go on, never lowered
//
// Threads: none inside; one owner.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "common/wire/messages.h"
#include "replay_server/core/session_table.h"

namespace shoal::replay {

class CreditBook {
 public:
  // Borrows the table.
  CreditBook(const SessionTable& sessions, uint64_t spec_hash, uint64_t replay_session,
             uint64_t window_records);

  // Takes over new sessions and newly dealt-with records; raises windows if `may_insert`.
  void Refresh(bool may_insert);
  // Credits of newest sessions; `changed_only`: those that differ from what was taken last.
  std::vector<Credit> Take(bool changed_only);

  // What has changed should be told now: an actor has half of its window or less left by what was
  // taken last, or has not been told anything yet.
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

  const SessionTable& sessions_;
  const uint64_t spec_hash_, replay_session_, window_records_;
  std::map<uint32_t, Account> accounts_;  // by actor
};

}  // namespace shoal::replay
