// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/intake.h"

#include "common/base/error.h"

namespace shoal::replay {
namespace {

// Counts records whose session counters were not written, because the writer died in between.
// Throws Error if ring and sessions disagree.
void CountStored(const Ring& ring, SessionTable* sessions) {
  for (uint64_t id = ring.oldest_id(); id <= ring.last_id(); ++id) {
    const SlotHeader& slot = ring.Slot(id);
    const uint64_t sequence = ring.Header(id).sequence;
    const std::optional<int> i = sessions->Find(slot.actor, slot.session);
    if (!i)
      throw RuntimeError("the replay file has records of an unknown session {}", slot.session);
    SessionCounters counters = sessions->at(*i);
    if (sequence <= counters.highest) continue;
    counters.highest = sequence;
    sessions->Update(*i, counters);
  }
  if (sessions->TotalStored() != ring.last_id()) {
    throw RuntimeError("the replay file is damaged: its sessions stored {} records, its ring {}",
                       sessions->TotalStored(), ring.last_id());
  }
}

SessionTable* Counted(const Ring& ring, SessionTable* sessions) {
  CountStored(ring, sessions);
  return sessions;
}

}  // namespace

Intake::Intake(uint64_t spec_hash, Ring* ring, SessionTable* sessions, EpisodeIndex* index)
    : ring_(*ring),
      index_(*index),
      chunks_(spec_hash, ring->layout(), Counted(*ring, sessions), this) {}

bool Intake::Take(const SessionCounters& session, const uint8_t* record) {
  const RecordHeader& header = RecordLayout::Header(record);
  const std::optional<uint64_t> prev = index_.Predecessor(session.actor, session.session, header);
  if (!prev) {
    OnGap(session, header.env);
    return false;
  }
  index_.Added(ring_.Append(session.actor, session.session, *prev, record));
  return true;
}

void Intake::OnGap(const SessionCounters& session, uint32_t env) {
  index_.Close(session.actor, session.session, env);
}

}  // namespace shoal::replay
