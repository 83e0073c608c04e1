// SPDX-License-Identifier: Apache-2.0
#include "common/intake/credit_book.h"

#include <algorithm>

namespace shoal {

CreditBook::CreditBook(const SessionLedger& sessions, uint64_t spec_hash, uint64_t receiver_session,
                       uint64_t window_records, uint64_t least_records)
    : sessions_(sessions),
      spec_hash_(spec_hash),
      receiver_session_(receiver_session),
      window_records_(window_records),
      least_records_(std::min(least_records, window_records)) {}

uint64_t CreditBook::Share(std::optional<uint64_t> steps_left) const {
  if (!steps_left) return window_records_;
  if (*steps_left == 0) return 0;
  const uint64_t sessions = std::max<uint64_t>(1, sessions_.newest().size());
  return std::clamp((*steps_left + sessions - 1) / sessions, least_records_, window_records_);
}

void CreditBook::Refresh(bool may_insert, std::optional<uint64_t> steps_left) {
  const uint64_t share = Share(steps_left);
  for (const auto& [actor, i] : sessions_.newest()) {
    const SessionCounters& counters = sessions_.at(i);
    Account& account = accounts_[actor];
    if (account.session != counters.session) account = {.session = counters.session};
    uint64_t allowed = std::max(account.allowed, counters.highest);
    if (may_insert) allowed = counters.highest + window_records_;
    allowed = std::min(allowed, counters.highest + share);
    if (allowed == account.allowed && counters.highest == account.stored) continue;
    account.stored = counters.highest;
    account.allowed = allowed;
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
    credits.push_back({.replay_session = receiver_session_,
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

}  // namespace shoal
