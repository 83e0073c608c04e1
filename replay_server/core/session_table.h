// Accounting per actor session, kept in the ring's mapping so that it outlives the process.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "replay_server/core/ring_format.h"

namespace shoal::replay {

// What became of the records of one (actor, session). Sequences 1..highest were dealt with; each is
// counted once:  highest = stored + rejected + after_gap + lost.
struct SessionCounters {
  uint32_t actor = 0;
  uint64_t session = 0;
  uint64_t highest = 0;
  uint64_t rejected = 0;    // malformed
  uint64_t after_gap = 0;   // its predecessor in the episode is not stored
  uint64_t lost = 0;        // stored by an earlier server whose memory is gone
  uint64_t duplicates = 0;  // came again; not part of the sum

  uint64_t stored() const { return highest - rejected - after_gap - lost; }
  bool operator==(const SessionCounters&) const = default;
};

// What an earlier server of the run left when its ring is gone.
struct FormerServer {
  uint64_t stored_steps = 0;
  std::vector<SessionCounters> sessions;
};

class SessionTable {
 public:
  // `storage` is borrowed. Sessions found there are loaded. Throws Error when one is damaged.
  explicit SessionTable(std::span<StoredSession> storage);

  int size() const { return static_cast<int>(sessions_.size()); }
  const SessionCounters& at(int i) const { return sessions_[static_cast<size_t>(i)]; }
  std::optional<int> Find(uint32_t actor, uint64_t session) const;
  // The actor's session that started last; nothing for an unknown actor.
  std::optional<int> Newest(uint32_t actor) const;
  // Indices of the newest session of each actor, by actor.
  const std::map<uint32_t, int>& newest() const { return newest_; }

  // Adds a session with counters of zero; nothing when the table is full.
  std::optional<int> Add(uint32_t actor, uint64_t session);
  // Replaces a session's counters, in one step as seen by recovery.
  void Update(int i, const SessionCounters& counters);

  // Into an empty table: the sessions of a server whose ring is gone. What it had stored is lost.
  void Inherit(const FormerServer& former);

  uint64_t TotalStored() const;

 private:
  void Index(int i);

  std::span<StoredSession> storage_;
  std::vector<SessionCounters> sessions_;
  std::vector<uint64_t> versions_;
  std::map<std::pair<uint32_t, uint64_t>, int> by_name_;
  std::map<uint32_t, int> newest_;
};

}  // namespace shoal::replay
