// SPDX-License-Identifier: Apache-2.0
// Extracts the records of chunks in order, for the replay server and for the learner. Detects and
// counts duplicates and gaps. For each (actor, session), each sequence up to the highest is handled
// exactly once.
//
// Resending. An actor keeps records until the receiver acknowledges them, and resends the oldest
// records first. Therefore, if a chunk arrives before earlier records, nothing is lost: the chunk
// is dropped, and the actor sends it again.
//
// Takeover. Actors free records after they are acknowledged. If the receiver that acknowledged the
// records lost its memory, the records are lost. Before an actor resends, it therefore reports the
// first sequence that it still has: it sends a chunk without records whose first_sequence is this
// sequence. At the first report of a session, the sequences after the highest sequence that this
// receiver has handled and before the reported sequence count as lost. Later reports of a session
// cannot reveal a loss, because no other receiver acknowledges records.
//
// Sessions from the future. A session number is the actor's clock at its start, and the newest
// session supersedes the others. A number far in the future would exclude the true actor for ever,
// so such a number is refused.
//
// Threads: starts no threads; not thread-safe, one owner.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <set>

#include "common/intake/session_ledger.h"
#include "common/spec/record.h"
#include "common/wire/messages.h"

namespace shoal {

enum class ChunkFate {
  kDealtWith,   // every record of the chunk is stored or counted
  kAhead,       // dropped, because records before the chunk have not arrived yet
  kSuperseded,  // dropped, because the actor has a newer session
  kFuture,      // the session number is a time in the future
  kWrongSpec,   // the chunk has another observation spec
  kMalformed,   // length or sequences of the chunk are inconsistent
  kTableFull,   // the ledger already has its largest number of sessions
};

struct ChunkResult {
  ChunkFate fate = ChunkFate::kDealtWith;
  uint32_t stored = 0, rejected = 0, after_gap = 0, duplicates = 0;  // records of the chunk
  uint64_t lost = 0;            // sequences before the chunk that count as lost
  const char* fault = nullptr;  // reason for the last rejection of a record
};

// Sink for the records of an intake.
class RecordTaker {
 public:
  virtual ~RecordTaker() = default;
  // Stores the next valid record of a session. The record is aligned to 8 and borrowed. Returns
  // false if the record cannot be used because its predecessor in the episode is missing.
  virtual bool Take(const SessionCounters& session, const uint8_t* record) = 0;
  // Called after a record was rejected. The rest of this environment's episode follows a gap.
  virtual void OnGap(const SessionCounters& session, uint32_t env) = 0;
};

class ChunkIntake {
 public:
  // An actor's new session is always accepted if its number exceeds the number of the actor's
  // newest known session by at most kSessionStep. The reason: the actor's clock may have been set
  // back (common/config/session_number.h).
  static constexpr uint64_t kSessionStep = 1'000'000'000;

  // Borrows ledger and taker. For each session that is already in the ledger, the next chunk is the
  // first one that this process receives.
  ChunkIntake(uint64_t spec_hash, const RecordLayout& layout, SessionLedger* sessions,
              RecordTaker* taker);

  // Handles a chunk. `chunk.payload` must be aligned to 8. `latest_session`: the highest number
  // that a session may have now.
  ChunkResult Take(const TransitionChunk& chunk,
                   uint64_t latest_session = std::numeric_limits<uint64_t>::max());

 private:
  bool WellFormed(const TransitionChunk& chunk) const;
  // Returns the index of the chunk's session, after adding the session if it is new. If the chunk
  // must not be used, returns empty and sets `fate` to the reason.
  std::optional<int> FindSession(const TransitionChunk& chunk, uint64_t latest_session,
                                 ChunkFate* fate);
  // Handles a chunk without records.
  ChunkResult TakePosition(const TransitionChunk& chunk, int i);
  void TakeRecord(const uint8_t* record, uint64_t sequence, SessionCounters* counters,
                  ChunkResult* result);

  const uint64_t spec_hash_;
  const RecordLayout layout_;
  SessionLedger& sessions_;
  RecordTaker& taker_;
  std::set<int> unheard_;  // indices of sessions from which no chunk has arrived in this process
};

// Reply to an actor whose chunk was refused because of another spec or a newer session.
Credit Refusal(const TransitionChunk& chunk, const SessionLedger& sessions, uint64_t spec_hash,
               uint64_t receiver_session);

}  // namespace shoal
