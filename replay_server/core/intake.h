// From chunks to stored records: duplicates, gaps and malformed records are sorted out and counted
// here. Per (actor, session) every sequence up to the highest is dealt with exactly once.
//
// Resending. An actor keeps what is not reported stored and resends it oldest first, so a chunk
// ahead of the next expected sequence is not a loss yet: it is set aside and will come again. Only
// when the actor offers the same chunk as its oldest kAheadOffers times is the part before it taken
// as lost (the ring that had it was in the memory of a server that died).
//
// Threads: none inside; one owner.
#pragma once

#include <cstdint>
#include <map>

#include "common/wire/messages.h"
#include "replay_server/core/episode_index.h"
#include "replay_server/core/ring.h"
#include "replay_server/core/session_table.h"

namespace shoal::replay {

enum class ChunkFate {
  kDealtWith,   // every record in it is stored or counted
  kAhead,       // set aside: what lies before it did not come yet
  kSuperseded,  // of a session whose actor has a newer one: its process is gone
  kWrongSpec,   // another observation spec
  kMalformed,   // its length or sequences make no sense
  kTableFull,   // kMaxSessions actor sessions are known
};

struct ChunkResult {
  ChunkFate fate = ChunkFate::kDealtWith;
  uint32_t stored = 0, rejected = 0, after_gap = 0, duplicates = 0;  // of its records
  uint64_t lost = 0;            // sequences taken as lost before it
  const char* fault = nullptr;  // why the last rejected record was rejected
};

class Intake {
 public:
  static constexpr int kAheadOffers = 3;

  // Borrows all three. Accounts for records that were stored after their session's counters were
  // last written (the writer died between the two). Throws Error when ring and sessions disagree.
  Intake(uint64_t spec_hash, Ring* ring, SessionTable* sessions, EpisodeIndex* index);

  // `chunk.payload` must be aligned to 8.
  ChunkResult Take(const TransitionChunk& chunk);

 private:
  struct Ahead {
    uint64_t first_sequence = 0;
    int offers = 0;
  };

  bool WellFormed(const TransitionChunk& chunk) const;
  // True when the chunk may be taken now; `counters` then has the lost ones.
  bool Reaches(const TransitionChunk& chunk, SessionCounters* counters, uint64_t* lost);
  void TakeRecord(const uint8_t* record, uint64_t sequence, SessionCounters* counters,
                  ChunkResult* result);

  const uint64_t spec_hash_;
  Ring& ring_;
  SessionTable& sessions_;
  EpisodeIndex& index_;
  std::map<int, Ahead> ahead_;  // by session index
};

}  // namespace shoal::replay
