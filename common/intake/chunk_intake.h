// SPDX-License-Identifier: Apache-2.0
// Turns chunks into records in order, for the replay server and for the learner. Duplicates and
// gaps are detected and counted here. Per (actor, session), each sequence up to the highest is
// handled exactly once.
//
// Resending. An actor retains records until they are reported stored and resends them oldest first.
// So a chunk ahead of the next expected sequence is not a loss yet: it is dropped, and the actor
// sends it again.
//
// Takeover. Actors free records once they are acknowledged. If the receiver that acknowledged the
// records lost its memory, the records are gone. Before an actor resends, it therefore reports
// where its retained records begin: it sends a chunk without records, whose first_sequence is the
// first retained sequence. At the first report of a session, the sequences between the highest one
// that this receiver knows and the reported one count as lost. Later reports of a session cannot
// reveal a loss, because no other receiver acknowledges records.
//
// Sessions from the future. A session number is the actor's clock at its start, and the newest
// session supersedes the others. A number far in the future would exclude the true actor for good,
// so it is refused.
//
// Threads: starts none; not thread-safe, one owner.
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
  kAhead,       // dropped: records before the chunk have not arrived yet
  kSuperseded,  // the actor has a newer session: the process that sent the chunk is gone
  kFuture,      // the session number is of a time in the future
  kWrongSpec,   // the chunk has another observation spec
  kMalformed,   // length or sequences of the chunk are inconsistent
  kTableFull,   // the ledger has no room for another session
};

struct ChunkResult {
  ChunkFate fate = ChunkFate::kDealtWith;
  uint32_t stored = 0, rejected = 0, after_gap = 0, duplicates = 0;  // records of the chunk
  uint64_t lost = 0;            // sequences before the chunk that count as lost
  const char* fault = nullptr;  // why the last rejected record was rejected
};

// Sink for the records of an intake.
class RecordTaker {
 public:
  virtual ~RecordTaker() = default;
  // Stores the next valid record of a session. The record is aligned to 8 and borrowed. Returns
  // false if the record cannot be used because its predecessor in the episode is missing.
  virtual bool Take(const SessionCounters& session, const uint8_t* record) = 0;
  // A record was rejected: the rest of this environment's episode follows a gap.
  virtual void OnGap(const SessionCounters& session, uint32_t env) = 0;
};

class ChunkIntake {
 public:
  // How far an actor's new session may lie beyond its former one, whatever the clock says: its
  // clock may have been set back since (common/config/session_number.h).
  static constexpr uint64_t kSessionStep = 1'000'000'000;

  // Borrows ledger and taker. The intake has not heard yet from the sessions that are already in
  // the ledger.
  ChunkIntake(uint64_t spec_hash, const RecordLayout& layout, SessionLedger* sessions,
              RecordTaker* taker);

  // `chunk.payload` must be aligned to 8. `latest_session`: the highest number that a session may
  // have now.
  ChunkResult Take(const TransitionChunk& chunk,
                   uint64_t latest_session = std::numeric_limits<uint64_t>::max());

 private:
  bool WellFormed(const TransitionChunk& chunk) const;
  // Index of the chunk's session, which is added if it is new. Otherwise empty, and `fate` has the
  // reason why the chunk is not taken.
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
