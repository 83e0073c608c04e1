// Which record follows which, and which steps can be sampled.
//
//   A step s with predecessors p1 = prev(s), p2 = prev(p1), ... is the last of n = n_step steps
//   that begin at the observation pn, a stack of K frames. It can be sampled iff p1..pn exist and
//   they and p(n+1)..p(n+K-1), or what the episode has of them, are in the ring.
//
// The ring drops its oldest record first and predecessors are older than s, so s can be sampled
// from the moment it is stored until the oldest of these is overwritten. Each slot counts the steps
// that need its record as their oldest one; overwriting it takes that many away at once. The number
// of sampleable steps is therefore exact after every record, at no search.
//
// Threads: none inside; one owner. Memory: 12 bytes per slot.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "common/spec/record.h"
#include "replay_server/core/ring.h"

namespace shoal::replay {

class EpisodeIndex {
 public:
  // Borrows the ring and reads what is in it, calling `alive` for each record, if there is one;
  // records of a snapshot that vanished are skipped. stack, n_step >= 1.
  EpisodeIndex(const Ring& ring, int stack, int n_step = 1, const Alive& alive = {});

  // Memory it takes for a ring of that many records.
  static constexpr uint64_t Bytes(uint64_t capacity) {
    return capacity * (sizeof(uint64_t) + sizeof(uint32_t));
  }

  // What a record of this actor session may be stored as the successor of: 0 for a reset, the id of
  // the environment's last stored record if the step continues that very episode, nothing else.
  std::optional<uint64_t> Predecessor(uint32_t actor, uint64_t session,
                                      const RecordHeader& header) const;
  // Call after each Ring::Append, with the id it returned.
  void Added(uint64_t id);
  // A record of `env` is missing: its open episode ends at the last stored one.
  void Close(uint32_t actor, uint64_t session, uint32_t env);

  bool Sampleable(uint64_t id) const;
  uint64_t sampleable() const { return sampleable_; }
  // How often a step became sampleable since construction.
  uint64_t became_sampleable() const { return became_sampleable_; }
  // Episodes that ended neither terminated nor truncated, seen when the next one began or a record
  // was missing. Since construction.
  uint64_t cut_episodes() const { return cut_episodes_; }

 private:
  // Where an environment stands.
  struct Track {
    uint64_t session = 0;
    uint64_t last_id = 0;
    uint32_t actor = 0;
    uint32_t episode = 0;
    uint32_t index = 0;
    bool open = false;  // a next step may follow
  };

  void Follow(uint64_t id);
  // The oldest record that a sample ending at `id` needs; 0 when it is gone or never was.
  uint64_t OldestNeeded(uint64_t id) const;

  const Ring& ring_;
  const int stack_, n_step_;
  std::unordered_map<uint32_t, Track> tracks_;  // by env
  std::vector<uint64_t> oldest_needed_;         // by slot; 0 = not a step, or never sampleable
  std::vector<uint32_t> needed_by_;             // by slot: sampleable steps whose oldest it is
  uint64_t sampleable_ = 0, became_sampleable_ = 0, cut_episodes_ = 0;
};

}  // namespace shoal::replay
