// Accounting per actor session: what became of every record that an actor sent, whoever receives
// them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace shoal {

// What became of the records of one (actor, session). Sequences 1..highest were dealt with; each is
// counted once:  highest = stored + rejected + after_gap + lost + discarded.
struct SessionCounters {
  uint32_t actor = 0;
  uint64_t session = 0;
  uint64_t highest = 0;
  uint64_t rejected = 0;    // malformed
  uint64_t after_gap = 0;   // its predecessor in the episode is not stored
  uint64_t lost = 0;        // stored by an earlier receiver whose memory is gone
  uint64_t discarded = 0;   // of a rollout that no update was made of
  uint64_t duplicates = 0;  // came again; not part of the sum

  uint64_t stored() const { return highest - rejected - after_gap - lost - discarded; }
  bool operator==(const SessionCounters&) const = default;
};

// In memory. One owner.
class SessionLedger {
 public:
  explicit SessionLedger(size_t most_sessions) : most_sessions_(most_sessions) {}
  SessionLedger(SessionLedger&&) = default;
  virtual ~SessionLedger() = default;

  int size() const { return static_cast<int>(sessions_.size()); }
  const SessionCounters& at(int i) const { return sessions_[static_cast<size_t>(i)]; }
  std::optional<int> Find(uint32_t actor, uint64_t session) const;
  // The actor's session that started last; nothing for an unknown actor.
  std::optional<int> Newest(uint32_t actor) const;
  // Indices of the newest session of each actor, by actor.
  const std::map<uint32_t, int>& newest() const { return newest_; }

  // Adds a session with counters of zero; nothing when the ledger is full.
  std::optional<int> Add(uint32_t actor, uint64_t session);
  // Replaces a session's counters. CHECK: they are of that session.
  void Update(int i, const SessionCounters& counters);

  uint64_t TotalStored() const;

 protected:
  // Takes over a session that was kept somewhere.
  void Load(const SessionCounters& counters);

 private:
  // A session was added or changed.
  virtual void OnUpdate(int /*i*/, const SessionCounters& /*counters*/) {}
  void Index(int i);

  size_t most_sessions_;
  std::vector<SessionCounters> sessions_;
  std::map<std::pair<uint32_t, uint64_t>, int> by_name_;
  std::map<uint32_t, int> newest_;
};

}  // namespace shoal
