// SPDX-License-Identifier: Apache-2.0
// Stores the records of chunks (common/intake/chunk_intake.h) in the ring. Each stored record
// refers to its predecessor in the episode.
//
// The counters of a session are written after each record. If this process is killed between the
// two writes, one stored record is not counted. The constructor of the next process finds this
// record by its sequence.
//
// Starts no threads; not thread-safe, one owner.
#pragma once

#include <cstdint>
#include <limits>

#include "common/intake/chunk_intake.h"
#include "common/wire/messages.h"
#include "replay_server/core/episode_index.h"
#include "replay_server/core/ring.h"
#include "replay_server/core/session_table.h"

namespace shoal::replay {

class Intake final : private RecordTaker {
 public:
  // Borrows ring, sessions and index. Counts a record that was stored but not counted when a former
  // process was killed. Throws Error if the ring and the sessions disagree.
  Intake(uint64_t spec_hash, Ring* ring, SessionTable* sessions, EpisodeIndex* index);
  Intake(const Intake&) = delete;
  Intake& operator=(const Intake&) = delete;

  // See ChunkIntake.
  ChunkResult Take(const TransitionChunk& chunk,
                   uint64_t latest_session = std::numeric_limits<uint64_t>::max()) {
    return chunks_.Take(chunk, latest_session);
  }

 private:
  bool Take(const SessionCounters& session, const uint8_t* record) override;
  void OnGap(const SessionCounters& session, uint32_t env) override;

  Ring& ring_;
  EpisodeIndex& index_;
  ChunkIntake chunks_;
};

}  // namespace shoal::replay
