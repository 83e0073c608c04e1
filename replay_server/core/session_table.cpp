// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/session_table.h"

#include <algorithm>
#include <atomic>
#include <optional>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/random.h"
#include "replay_server/core/ring_recovery.h"

namespace shoal::replay {
namespace {

uint64_t CheckWord(const SessionCopy& copy) {
  const auto* bytes = reinterpret_cast<const uint8_t*>(&copy) + sizeof(copy.check);
  return std::max<uint64_t>(1, HashBytes(bytes, sizeof(copy) - sizeof(copy.check)));
}

bool Valid(const SessionCopy& copy) { return copy.check != 0 && copy.check == CheckWord(copy); }

bool NeverWritten(const SessionCopy& copy) { return copy.check == 0 && copy.version == 0; }

SessionCounters FromCopy(const SessionCopy& copy) {
  return {.actor = static_cast<uint32_t>(copy.actor),
          .session = copy.session,
          .highest = copy.highest,
          .rejected = copy.rejected,
          .after_gap = copy.after_gap,
          .lost = copy.lost,
          .discarded = 0,
          .duplicates = copy.duplicates};
}

// The newest valid copy, or nullptr. A session is in use once its first copy is complete; the first
// copy is copy 1 (version 1). A copy 0 without copy 1 means damage.
const SessionCopy* NewestCopy(const StoredSession& stored) {
  const bool valid[2] = {Valid(stored.copies[0]), Valid(stored.copies[1])};
  if (valid[0] && valid[1]) {
    return &stored.copies[stored.copies[0].version > stored.copies[1].version ? 0 : 1];
  }
  if (valid[0]) return &stored.copies[0];
  return valid[1] ? &stored.copies[1] : nullptr;
}

}  // namespace

SessionTable::SessionTable(std::span<StoredSession> storage)
    : SessionLedger(storage.size()), storage_(storage) {
  for (const StoredSession& stored : storage) {
    const SessionCopy* copy = NewestCopy(stored);
    if (copy == nullptr) {
      // The place is free, or the writer died while it added the session. Copy 0 is then unwritten.
      if (NeverWritten(stored.copies[0])) break;
      throw UsageError("the replay file's session {} is damaged; {}", size(), kRingRemedy);
    }
    versions_.push_back(copy->version);
    Load(FromCopy(*copy));
  }
}

void SessionTable::OnUpdate(int i, const SessionCounters& counters) {
  CHECK(counters.discarded == 0) << "a replay keeps what it takes";
  const size_t index = static_cast<size_t>(i);
  if (index == versions_.size()) versions_.push_back(0);
  const uint64_t version = ++versions_[index];
  SessionCopy& copy = storage_[index].copies[version % 2];
  const std::atomic_ref<uint64_t> check(copy.check);
  check.store(0, std::memory_order_relaxed);
  std::atomic_signal_fence(std::memory_order_seq_cst);  // the writer may die between any two stores
  copy.version = version;
  copy.session = counters.session;
  copy.actor = counters.actor;
  copy.highest = counters.highest;
  copy.rejected = counters.rejected;
  copy.after_gap = counters.after_gap;
  copy.lost = counters.lost;
  copy.duplicates = counters.duplicates;
  check.store(CheckWord(copy), std::memory_order_release);
}

void SessionTable::TakeOver(const FormerServer& former) {
  for (SessionCounters counters : former.sessions) {
    std::optional<int> i = Find(counters.actor, counters.session);
    if (i && at(*i).highest >= counters.highest) continue;
    const uint64_t ours = i ? at(*i).stored() : 0;
    if (!i) i = Add(counters.actor, counters.session);
    if (!i) return;  // the table is full, as the previous server's was; the next chunk reports it
    // Records that a learner discarded (on policy) are lost like the stored ones.
    const uint64_t former_ones = counters.stored() + counters.discarded;
    if (former_ones > ours) counters.lost += former_ones - ours;
    counters.discarded = 0;
    Update(*i, counters);
  }
}

bool SessionTable::StoresLessThan(const FormerServer& former) const {
  return std::ranges::any_of(former.sessions, [this](const SessionCounters& counters) {
    const std::optional<int> i = Find(counters.actor, counters.session);
    return counters.stored() > (i ? at(*i).stored() : 0);
  });
}

}  // namespace shoal::replay
