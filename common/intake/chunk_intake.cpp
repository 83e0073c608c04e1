// SPDX-License-Identifier: Apache-2.0
#include "common/intake/chunk_intake.h"

#include <limits>

#include "common/base/check.h"

namespace shoal {

ChunkIntake::ChunkIntake(uint64_t spec_hash, const RecordLayout& layout, SessionLedger* sessions,
                         RecordTaker* taker)
    : spec_hash_(spec_hash), layout_(layout), sessions_(*sessions), taker_(*taker) {
  for (int i = 0; i < sessions_.size(); ++i) unheard_.insert(i);
}

bool ChunkIntake::WellFormed(const TransitionChunk& chunk) const {
  const uint64_t record_bytes = static_cast<uint64_t>(layout_.record_bytes());
  return chunk.first_sequence > 0 &&
         chunk.first_sequence <= std::numeric_limits<uint64_t>::max() - chunk.count &&
         chunk.payload.size() == chunk.count * record_bytes;
}

std::optional<int> ChunkIntake::FindSession(const TransitionChunk& chunk, uint64_t latest_session,
                                            ChunkFate* fate) {
  const std::optional<int> newest = sessions_.Newest(chunk.actor);
  const uint64_t known = newest ? sessions_.at(*newest).session : 0;
  if (known > chunk.session) {
    *fate = ChunkFate::kSuperseded;
    return std::nullopt;
  }
  std::optional<int> i = sessions_.Find(chunk.actor, chunk.session);
  if (i) return i;
  // chunk.session > known, so the difference cannot wrap around.
  const bool follows = newest && chunk.session - known <= kSessionStep;
  if (chunk.session > latest_session && !follows) {
    *fate = ChunkFate::kFuture;
    return std::nullopt;
  }
  i = sessions_.Add(chunk.actor, chunk.session);
  if (i) {
    unheard_.insert(*i);
  } else {
    *fate = ChunkFate::kTableFull;
  }
  return i;
}

ChunkResult ChunkIntake::TakePosition(const TransitionChunk& chunk, int i) {
  SessionCounters counters = sessions_.at(i);
  ChunkResult result;
  if (chunk.first_sequence <= counters.highest + 1) return result;
  if (unheard_.erase(i) == 0) return {.fate = ChunkFate::kAhead};  // not a session's first message
  result.lost = chunk.first_sequence - 1 - counters.highest;
  counters.lost += result.lost;
  counters.highest += result.lost;
  sessions_.Update(i, counters);
  return result;
}

ChunkResult ChunkIntake::Take(const TransitionChunk& chunk, uint64_t latest_session) {
  if (chunk.spec_hash != spec_hash_) return {.fate = ChunkFate::kWrongSpec};
  if (!WellFormed(chunk)) return {.fate = ChunkFate::kMalformed};
  CHECK(reinterpret_cast<uintptr_t>(chunk.payload.data()) % 8 == 0);
  ChunkResult result;
  const std::optional<int> i = FindSession(chunk, latest_session, &result.fate);
  if (!i) return result;
  if (chunk.count == 0) return TakePosition(chunk, *i);

  SessionCounters counters = sessions_.at(*i);
  if (chunk.first_sequence > counters.highest + 1) return {.fate = ChunkFate::kAhead};
  unheard_.erase(*i);
  // The counters are written after each record. If this process is killed, at most one stored
  // record is not counted, and the constructor finds that record by its sequence.
  const size_t record_bytes = static_cast<size_t>(layout_.record_bytes());
  for (uint32_t k = 0; k < chunk.count; ++k) {
    const uint64_t sequence = chunk.first_sequence + k;
    if (sequence <= counters.highest) {
      ++counters.duplicates;
      ++result.duplicates;
      continue;
    }
    TakeRecord(chunk.payload.data() + k * record_bytes, sequence, &counters, &result);
    sessions_.Update(*i, counters);
  }
  // For a chunk of duplicates alone, the loop has not written the counters.
  if (result.duplicates == chunk.count) sessions_.Update(*i, counters);
  return result;
}

void ChunkIntake::TakeRecord(const uint8_t* record, uint64_t sequence, SessionCounters* counters,
                             ChunkResult* result) {
  const RecordHeader& header = RecordLayout::Header(record);
  counters->highest = sequence;
  const char* fault = header.sequence != sequence ? "record sequence does not fit its chunk"
                                                  : RecordFault(layout_, record);
  if (fault != nullptr) {
    taker_.OnGap(*counters, header.env);
    ++counters->rejected;
    ++result->rejected;
    result->fault = fault;
  } else if (taker_.Take(*counters, record)) {
    ++result->stored;
  } else {
    ++counters->after_gap;
    ++result->after_gap;
  }
}

Credit Refusal(const TransitionChunk& chunk, const SessionLedger& sessions, uint64_t spec_hash,
               uint64_t receiver_session) {
  const std::optional<int> newest = sessions.Newest(chunk.actor);
  const uint64_t session = newest ? sessions.at(*newest).session : 0;
  return {.replay_session = receiver_session,
          .actor = chunk.actor,
          .session = chunk.session,
          .stored = 0,
          .allowed = 0,
          .spec_hash = spec_hash,
          .superseded_by = session > chunk.session ? session : 0};
}

}  // namespace shoal
