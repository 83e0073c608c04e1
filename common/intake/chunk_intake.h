// SPDX-License-Identifier: Apache-2.0
// Turns chunks into records in order, for the replay server and for the learner. Duplicates and
// gaps are detected and counted here. Per (actor, session), each sequence up to the highest is
// handled exactly once.
//
// Resending. An actor retains records until they are reported stored and resends them oldest first.
// So a chunk ahead of the next expected sequence is not a loss yet: it is dropped, and the actor
// sends it again.
//
// Takeover. Actors free records once they are acknowledged. If the receiver that acknowledged them
// lost its memory, those records are gone. So whenever an actor resends, it reports first
// where its retained records begin: a chunk without records, whose first_sequence that is. At the
// first report of a session, the sequences between those that this receiver knows and that one
// count as lost. Later reports of a session cannot reveal a loss: no other receiver acknowledges
// records.
//
// Sessions from the future. A session is the actor's clock at its start, and the newest supersedes
// the others: a number far beyond the present would shut the true actor out for good.
//
// Threads: none inside; one owner.
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
  kDealtWith,   // every record in it is stored or counted
  kAhead,       // dropped: records before it have not arrived yet
  kSuperseded,  // of a session whose actor has a newer one: its process is gone
  kFuture,      // of a session that cannot have begun yet
  kWrongSpec,   // another observation spec
  kMalformed,   // its length or sequences make no sense
  kTableFull,   // as many actor sessions as the ledger holds are known
};

struct ChunkResult {
  ChunkFate fate = ChunkFate::kDealtWith;
  uint32_t stored = 0, rejected = 0, after_gap = 0, duplicates = 0;  // of its records
  uint64_t lost = 0;            // sequences taken as lost before it
  const char* fault = nullptr;  // why the last rejected record was rejected
};

// Who keeps the records of an intake.
class RecordTaker {
 public:
  virtual ~RecordTaker() = default;
  // A sound record, the next of its session, aligned to 8 and borrowed. False: its predecessor in
  // the episode is not there, so it is of no use.
  virtual bool Take(const SessionCounters& session, const uint8_t* record) = 0;
  // A record was rejected: what follows it in this environment's episode does not follow.
  virtual void OnGap(const SessionCounters& session, uint32_t env) = 0;
};

class ChunkIntake {
 public:
  // How far an actor's new session may lie beyond its former one, whatever the clock says: its
  // clock may have been set back since (common/config/session_number.h).
  static constexpr uint64_t kSessionStep = 1'000'000'000;

  // Borrows ledger and taker. Sessions that the ledger holds already are unheard of so far.
  ChunkIntake(uint64_t spec_hash, const RecordLayout& layout, SessionLedger* sessions,
              RecordTaker* taker);

  // `chunk.payload` must be aligned to 8. `latest_session`: none begun by now has a higher number.
  ChunkResult Take(const TransitionChunk& chunk,
                   uint64_t latest_session = std::numeric_limits<uint64_t>::max());

 private:
  bool WellFormed(const TransitionChunk& chunk) const;
  // The session's index, added where it is new; or why the chunk is not taken.
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
  std::set<int> unheard_;  // sessions, by index, of which this process has not heard anything
};

// The word to an actor whose chunk was refused: of another spec, or superseded.
Credit Refusal(const TransitionChunk& chunk, const SessionLedger& sessions, uint64_t spec_hash,
               uint64_t receiver_session);

}  // namespace shoal
