// SPDX-License-Identifier: Apache-2.0
#include "common/intake/session_ledger.h"

#include "common/base/check.h"

namespace shoal {

void SessionLedger::Index(int i) {
  const SessionCounters& counters = at(i);
  by_name_[{counters.actor, counters.session}] = i;
  const auto [it, added] = newest_.try_emplace(counters.actor, i);
  if (!added && at(it->second).session < counters.session) it->second = i;
}

std::optional<int> SessionLedger::Find(uint32_t actor, uint64_t session) const {
  const auto it = by_name_.find({actor, session});
  return it == by_name_.end() ? std::nullopt : std::optional(it->second);
}

std::optional<int> SessionLedger::Newest(uint32_t actor) const {
  const auto it = newest_.find(actor);
  return it == newest_.end() ? std::nullopt : std::optional(it->second);
}

std::optional<int> SessionLedger::Add(uint32_t actor, uint64_t session) {
  CHECK(!Find(actor, session)) << "actor " << actor << " session " << session;
  if (sessions_.size() == most_sessions_) return std::nullopt;
  Load({.actor = actor, .session = session});
  const int i = size() - 1;
  OnUpdate(i, at(i));
  return i;
}

void SessionLedger::Load(const SessionCounters& counters) {
  sessions_.push_back(counters);
  Index(size() - 1);
}

void SessionLedger::Update(int i, const SessionCounters& counters) {
  CHECK(counters.actor == at(i).actor && counters.session == at(i).session);
  OnUpdate(i, counters);
  sessions_[static_cast<size_t>(i)] = counters;
}

uint64_t SessionLedger::TotalStored() const {
  uint64_t total = 0;
  for (const SessionCounters& counters : sessions_) total += counters.stored();
  return total;
}

}  // namespace shoal
