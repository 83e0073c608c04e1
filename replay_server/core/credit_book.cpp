#include "replay_server/core/credit_book.h"

#include <algorithm>

namespace shoal::replay {

CreditBook::CreditBook(const SessionTable& sessions, uint64_t spec_hash, uint64_t replay_session,
                       uint64_t window_records)
    : sessions_(sessions),
      spec_hash_(spec_hash),
      replay_session_(replay_session),
      window_records_(window_records) {}

void CreditBook::Refresh(bool may_insert) {
  for (const auto& [actor, i] : sessions_.newest()) {
    const SessionCounters& counters = sessions_.at(i);
    Account& account = accounts_[actor];
    if (account.session != counters.session) account = {.session = counters.session};
    uint64_t allowed = std::max(account.allowed, counters.highest);
    if (may_insert) allowed = counters.highest + window_records_;
    if (allowed == account.allowed && counters.highest == account.stored) continue;
    account.stored = counters.highest;
    account.allowed = std::max(account.allowed, allowed);
    account.changed = true;
  }
}

std::vector<Credit> CreditBook::Take(bool changed_only) {
  std::vector<Credit> credits;
  for (auto& [actor, account] : accounts_) {
    if (changed_only && !account.changed) continue;
    account.changed = false;
    account.told = true;
    account.told_stored = account.stored;
    credits.push_back({.replay_session = replay_session_,
                       .actor = actor,
                       .session = account.session,
                       .stored = account.stored,
                       .allowed = account.allowed,
                       .spec_hash = spec_hash_});
  }
  return credits;
}

bool CreditBook::Urgent() const {
  return std::ranges::any_of(accounts_, [this](const auto& entry) {
    const Account& account = entry.second;
    return account.changed &&
           (!account.told || account.stored - account.told_stored >= window_records_ / 2);
  });
}

bool CreditBook::Withholding() const {
  return std::ranges::any_of(accounts_, [this](const auto& entry) {
    return entry.second.allowed < entry.second.stored + window_records_;
  });
}

}  // namespace shoal::replay
