#include "replay_server/core/intake.h"

#include <limits>

#include "common/base/check.h"
#include "common/base/error.h"

namespace shoal::replay {

Intake::Intake(uint64_t spec_hash, Ring* ring, SessionTable* sessions, EpisodeIndex* index)
    : spec_hash_(spec_hash), ring_(*ring), sessions_(*sessions), index_(*index) {
  for (uint64_t id = ring_.oldest_id(); id <= ring_.last_id(); ++id) {
    const SlotHeader& slot = ring_.Slot(id);
    const uint64_t sequence = ring_.Header(id).sequence;
    const std::optional<int> i = sessions_.Find(slot.actor, slot.session);
    if (!i)
      throw RuntimeError("the replay file has records of an unknown session {}", slot.session);
    SessionCounters counters = sessions_.at(*i);
    if (sequence <= counters.highest) continue;
    counters.highest = sequence;
    sessions_.Update(*i, counters);
  }
  if (sessions_.TotalStored() != ring_.last_id()) {
    throw RuntimeError("the replay file is damaged: its sessions stored {} records, its ring {}",
                       sessions_.TotalStored(), ring_.last_id());
  }
  for (int i = 0; i < sessions_.size(); ++i) unheard_.insert(i);
}

bool Intake::WellFormed(const TransitionChunk& chunk) const {
  const uint64_t record_bytes = static_cast<uint64_t>(ring_.layout().record_bytes());
  return chunk.first_sequence > 0 &&
         chunk.first_sequence <= std::numeric_limits<uint64_t>::max() - chunk.count &&
         chunk.payload.size() == chunk.count * record_bytes;
}

std::optional<int> Intake::FindSession(const TransitionChunk& chunk, uint64_t latest_session,
                                       ChunkFate* fate) {
  const std::optional<int> newest = sessions_.Newest(chunk.actor);
  const uint64_t known = newest ? sessions_.at(*newest).session : 0;
  if (known > chunk.session) {
    *fate = ChunkFate::kSuperseded;
    return std::nullopt;
  }
  std::optional<int> i = sessions_.Find(chunk.actor, chunk.session);
  if (i) return i;
  // chunk.session > known: the difference cannot wrap.
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

ChunkResult Intake::TakePosition(const TransitionChunk& chunk, int i) {
  SessionCounters counters = sessions_.at(i);
  ChunkResult result;
  if (chunk.first_sequence <= counters.highest + 1) return result;
  if (unheard_.erase(i) == 0) return {.fate = ChunkFate::kAhead};  // it cannot be
  result.lost = chunk.first_sequence - 1 - counters.highest;
  counters.lost += result.lost;
  counters.highest += result.lost;
  sessions_.Update(i, counters);
  return result;
}

ChunkResult Intake::Take(const TransitionChunk& chunk, uint64_t latest_session) {
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
  // The counters are written after each record: whenever this process is killed, at most one stored
  // record is not counted yet, and the constructor finds it by its sequence.
  const size_t record_bytes = static_cast<size_t>(ring_.layout().record_bytes());
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
  if (result.duplicates == chunk.count) sessions_.Update(*i, counters);
  return result;
}

void Intake::TakeRecord(const uint8_t* record, uint64_t sequence, SessionCounters* counters,
                        ChunkResult* result) {
  const RecordHeader& header = RecordLayout::Header(record);
  counters->highest = sequence;
  const char* fault = header.sequence != sequence ? "record sequence does not fit its chunk"
                                                  : RecordFault(ring_.layout(), record);
  if (fault != nullptr) {
    index_.Close(counters->actor, counters->session, header.env);
    ++counters->rejected;
    ++result->rejected;
    result->fault = fault;
    return;
  }
  const std::optional<uint64_t> prev =
      index_.Predecessor(counters->actor, counters->session, header);
  if (!prev) {
    index_.Close(counters->actor, counters->session, header.env);
    ++counters->after_gap;
    ++result->after_gap;
    return;
  }
  index_.Added(ring_.Append(counters->actor, counters->session, *prev, record));
  ++result->stored;
}

}  // namespace shoal::replay
