// SPDX-License-Identifier: Apache-2.0
// Counts for each actor session how many of its records were stored, rejected or lost. The replay
// and, on policy, the learner use a ledger.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "common/run_folder/accounting_file.h"

namespace shoal {

// The ledger is in memory. Not thread-safe; one owner.
class SessionLedger {
 public:
  explicit SessionLedger(size_t most_sessions) : most_sessions_(most_sessions) {}
  SessionLedger(SessionLedger&&) = default;
  virtual ~SessionLedger() = default;

  int size() const { return static_cast<int>(sessions_.size()); }
  const std::vector<SessionCounters>& all() const { return sessions_; }
  const SessionCounters& at(int i) const { return sessions_[static_cast<size_t>(i)]; }
  std::optional<int> Find(uint32_t actor, uint64_t session) const;
  // Index of the actor's newest session; empty for an unknown actor.
  std::optional<int> Newest(uint32_t actor) const;
  // Indices of the newest session of each actor, by actor.
  const std::map<uint32_t, int>& newest() const { return newest_; }

  // Adds a session with counters of zero and returns its index; empty if the ledger is full.
  std::optional<int> Add(uint32_t actor, uint64_t session);
  // Replaces a session's counters. CHECKs that the new counters belong to this session.
  void Update(int i, const SessionCounters& counters);

  uint64_t TotalStored() const;

 protected:
  // Adds a session that a derived class has read from storage.
  void Load(const SessionCounters& counters);

 private:
  // Called after a session was added or changed.
  virtual void OnUpdate(int /*i*/, const SessionCounters& /*counters*/) {}
  void Index(int i);

  size_t most_sessions_;
  std::vector<SessionCounters> sessions_;
  std::map<std::pair<uint32_t, uint64_t>, int> by_name_;
  std::map<uint32_t, int> newest_;
};

}  // namespace shoal
