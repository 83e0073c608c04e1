#include "replay_server/core/episode_index.h"

#include "common/base/check.h"

namespace shoal::replay {

EpisodeIndex::EpisodeIndex(const Ring& ring, int stack, int n_step, const Alive& alive)
    : ring_(ring),
      stack_(stack),
      n_step_(n_step),
      oldest_needed_(ring.capacity()),
      needed_by_(ring.capacity()) {
  CHECK(stack >= 1 && n_step >= 1);
  for (uint64_t id = ring.oldest_id(); id <= ring.last_id(); ++id) {
    if (ring.Slot(id).id == id) Added(id);
    if (alive) alive();
  }
  became_sampleable_ = cut_episodes_ = 0;
}

std::optional<uint64_t> EpisodeIndex::Predecessor(uint32_t actor, uint64_t session,
                                                  const RecordHeader& header) const {
  if (header.kind == RecordKind::kReset) return 0;
  const auto it = tracks_.find(header.env);
  if (it == tracks_.end()) return std::nullopt;
  const Track& track = it->second;
  const bool continues = track.open && track.actor == actor && track.session == session &&
                         track.episode == header.episode && track.index + 1 == header.index;
  return continues ? std::optional(track.last_id) : std::nullopt;
}

void EpisodeIndex::Added(uint64_t id) {
  const uint64_t slot = id % ring_.capacity();
  sampleable_ -= needed_by_[slot];
  needed_by_[slot] = 0;
  oldest_needed_[slot] = OldestNeeded(id);
  if (oldest_needed_[slot] != 0) {
    ++needed_by_[oldest_needed_[slot] % ring_.capacity()];
    ++sampleable_;
    ++became_sampleable_;
  }
  Follow(id);
}

void EpisodeIndex::Follow(uint64_t id) {
  const RecordHeader& header = ring_.Header(id);
  Track& track = tracks_[header.env];
  if (track.open && header.kind == RecordKind::kReset) ++cut_episodes_;
  track = {.session = ring_.Slot(id).session,
           .last_id = id,
           .actor = ring_.Slot(id).actor,
           .episode = header.episode,
           .index = header.index,
           .open = (header.flags & (kTerminated | kTruncated)) == 0};
}

void EpisodeIndex::Close(uint32_t actor, uint64_t session, uint32_t env) {
  const auto it = tracks_.find(env);
  if (it == tracks_.end() || !it->second.open) return;
  if (it->second.actor != actor || it->second.session != session) return;
  it->second.open = false;
  ++cut_episodes_;
}

uint64_t EpisodeIndex::OldestNeeded(uint64_t id) const {
  if (ring_.Header(id).kind != RecordKind::kStep) return 0;
  uint64_t oldest = id;
  for (int k = 0; k < n_step_ + stack_ - 1; ++k) {
    const uint64_t prev = ring_.Slot(oldest).prev;
    if (prev == 0 && k < n_step_) return 0;  // fewer than n steps lead here
    if (prev == 0) break;                    // `oldest` is the reset, which the stack repeats
    if (!ring_.Holds(prev)) return 0;
    oldest = prev;
  }
  return oldest;
}

bool EpisodeIndex::Sampleable(uint64_t id) const {
  if (!ring_.Holds(id)) return false;
  const uint64_t oldest = oldest_needed_[id % ring_.capacity()];
  return oldest != 0 && oldest >= ring_.oldest_id();
}

}  // namespace shoal::replay
