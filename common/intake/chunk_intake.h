// SPDX-License-Identifier: Apache-2.0
// From chunks to records in order: duplicates and gaps are sorted out and counted here, whoever
// takes the records. Per (actor, session) every sequence up to the highest is dealt with exactly
// once.
//
// Resending. An actor keeps what is not reported stored and resends it oldest first, so a chunk
// ahead of the next expected sequence is not a loss yet: it is set aside and will come again.
//
// Taking over. What an earlier receiver reported stored the actor keeps no more; where that one's
// memory is gone, nobody has it. So whenever the actor sends again what it keeps, it says first
// where its keeping begins: a chunk without records, whose first_sequence that is. The first time
// that this receiver hears of a session, what lies between what it knows and that sequence is
// counted as lost. Afterwards it cannot be news: nobody else has reported anything stored.
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
  kAhead,       // set aside: what lies before it did not come yet
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
  // Of a chunk without records.
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
