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
}

bool Intake::WellFormed(const TransitionChunk& chunk) const {
  const uint64_t record_bytes = static_cast<uint64_t>(ring_.layout().record_bytes());
  return chunk.count > 0 && chunk.first_sequence > 0 &&
         chunk.first_sequence <= std::numeric_limits<uint64_t>::max() - chunk.count &&
         chunk.payload.size() == chunk.count * record_bytes;
}

bool Intake::Reaches(const TransitionChunk& chunk, SessionCounters* counters, uint64_t* lost) {
  const int i = *sessions_.Find(chunk.actor, chunk.session);
  if (chunk.first_sequence <= counters->highest + 1) {
    ahead_.erase(i);
    return true;
  }
  Ahead& ahead = ahead_[i];
  if (ahead.offers == 0 || chunk.first_sequence < ahead.first_sequence) {
    ahead = {.first_sequence = chunk.first_sequence, .offers = 1};
  } else if (chunk.first_sequence == ahead.first_sequence) {
    ++ahead.offers;
  }
  if (chunk.first_sequence != ahead.first_sequence || ahead.offers < kAheadOffers) return false;
  ahead_.erase(i);
  *lost = chunk.first_sequence - counters->highest - 1;
  counters->lost += *lost;
  counters->highest += *lost;
  return true;
}

ChunkResult Intake::Take(const TransitionChunk& chunk) {
  if (chunk.spec_hash != spec_hash_) return {.fate = ChunkFate::kWrongSpec};
  if (!WellFormed(chunk)) return {.fate = ChunkFate::kMalformed};
  CHECK(reinterpret_cast<uintptr_t>(chunk.payload.data()) % 8 == 0);
  const std::optional<int> newest = sessions_.Newest(chunk.actor);
  if (newest && sessions_.at(*newest).session > chunk.session) {
    return {.fate = ChunkFate::kSuperseded};
  }
  std::optional<int> i = sessions_.Find(chunk.actor, chunk.session);
  if (!i) i = sessions_.Add(chunk.actor, chunk.session);
  if (!i) return {.fate = ChunkFate::kTableFull};

  SessionCounters counters = sessions_.at(*i);
  ChunkResult result;
  if (!Reaches(chunk, &counters, &result.lost)) return {.fate = ChunkFate::kAhead};
  // The counters are written after each record: whenever this process is killed, at most one stored
  // record is not counted yet, and the constructor finds it by its sequence.
  if (result.lost > 0) sessions_.Update(*i, counters);
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
