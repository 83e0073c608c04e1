// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/episode_index.h"

#include "common/base/check.h"

namespace shoal::replay {

EpisodeIndex::EpisodeIndex(const Ring& ring, const IndexOptions& options,
                           const StartupProgress& progress)
    : ring_(ring),
      options_(options),
      next_(ring.capacity()),
      oldest_needed_(ring.capacity()),
      needed_by_(ring.capacity()) {
  CHECK(options.stack >= 1 && options.n_step >= 1);
  for (uint64_t id = ring.oldest_id(); id <= ring.last_id(); ++id) {
    if (ring.Slot(id).id == id) Added(id);
    if (progress) progress();
  }
  became_sampleable_ = cut_episodes_ = steps_ = 0;
}

void EpisodeIndex::SetSelector(Selector* selector) {
  selector_ = selector;
  if (selector == nullptr) return;
  for (uint64_t id = ring_.oldest_id(); id <= ring_.last_id(); ++id) {
    if (Sampleable(id)) selector->Added(id);
  }
}

std::optional<uint64_t> EpisodeIndex::Predecessor(uint32_t actor, uint64_t session,
                                                  const RecordHeader& header) const {
  const RecordKind first = options_.goal_pictures ? RecordKind::kGoal : RecordKind::kReset;
  if (header.kind == first) return 0;
  const auto it = tracks_.find(header.env);
  if (it == tracks_.end()) return std::nullopt;
  const Track& track = it->second;
  const bool continues = track.open && track.actor == actor && track.session == session &&
                         track.episode == header.episode && Follows(header, track);
  return continues ? std::optional(track.last_id) : std::nullopt;
}

// Whether the record continues the episode: a reset follows its goal, the first step follows the
// reset.
bool EpisodeIndex::Follows(const RecordHeader& header, const Track& last) {
  if (header.kind == RecordKind::kReset) return last.kind == RecordKind::kGoal;
  return last.kind != RecordKind::kGoal && last.index + 1 == header.index;
}

uint64_t EpisodeIndex::Previous(uint64_t id) const {
  // A predecessor has the lower id, except in a damaged file.
  const uint64_t prev = ring_.Slot(id).prev;
  return prev < id && ring_.Holds(prev) ? prev : 0;
}

void EpisodeIndex::Added(uint64_t id) {
  if (id > ring_.capacity()) Forget(id - ring_.capacity());
  const size_t slot = Slot(id);
  oldest_needed_[slot] = next_[slot] = 0;
  steps_ += ring_.Header(id).kind == RecordKind::kStep ? 1 : 0;
  if (const uint64_t prev = Previous(id); prev != 0) next_[Slot(prev)] = id;
  const bool ended = (ring_.Header(id).flags & (kTerminated | kTruncated)) != 0;
  if (!options_.whole_episodes) Complete(id);
  if (options_.whole_episodes && ended) CompleteEpisode(id);
  Follow(id);
}

void EpisodeIndex::Forget(uint64_t gone) {
  const size_t slot = Slot(gone);
  if (selector_ != nullptr && needed_by_[slot] > 0) {
    // Removes the samples that need the lost record. They begin with one of the next `stack` steps
    // or, with goal pictures, with any later step of the episode.
    uint64_t id = gone;
    const bool to_the_end = options_.goal_pictures;
    for (int k = 0; (to_the_end || k < options_.stack) && next_[Slot(id)] != 0; ++k) {
      id = next_[Slot(id)];
      if (oldest_needed_[Slot(id)] == gone) selector_->Removed(id);
    }
  }
  sampleable_ -= needed_by_[slot];
  needed_by_[slot] = 0;
}

void EpisodeIndex::Complete(uint64_t id) {
  const bool terminated = (ring_.Header(id).flags & kTerminated) != 0;
  uint64_t first = id;
  for (int steps = 1; steps <= options_.n_step && first != 0; ++steps) {
    if (ring_.Header(first).kind != RecordKind::kStep) return;  // fewer than n_step steps
    if (steps == options_.n_step || terminated) MakeSampleable(first);
    first = Previous(first);
  }
}

void EpisodeIndex::CompleteEpisode(uint64_t last) {
  const bool terminated = (ring_.Header(last).flags & kTerminated) != 0;
  int steps = 0;
  for (uint64_t first = last; first != 0; first = Previous(first)) {
    if (ring_.Header(first).kind != RecordKind::kStep) return;
    // A termination ends the sum of rewards, so fewer than n steps suffice.
    if (++steps >= options_.n_step || terminated) MakeSampleable(first);
  }
}

void EpisodeIndex::MakeSampleable(uint64_t first) {
  const uint64_t oldest = OldestNeeded(first);
  if (oldest == 0 || oldest_needed_[Slot(first)] != 0) return;
  oldest_needed_[Slot(first)] = oldest;
  ++needed_by_[Slot(oldest)];
  ++sampleable_;
  ++became_sampleable_;
  if (selector_ != nullptr) selector_->Added(first);
}

void EpisodeIndex::Follow(uint64_t id) {
  const RecordHeader& header = ring_.Header(id);
  Track& track = tracks_[header.env];
  // A record without a predecessor begins another episode.
  if (track.open && ring_.Slot(id).prev == 0) Cut(&track);
  track = {.session = ring_.Slot(id).session,
           .last_id = id,
           .actor = ring_.Slot(id).actor,
           .episode = header.episode,
           .index = header.index,
           .kind = header.kind,
           .open = (header.flags & (kTerminated | kTruncated)) == 0};
}

void EpisodeIndex::Close(uint32_t actor, uint64_t session, uint32_t env) {
  const auto it = tracks_.find(env);
  if (it == tracks_.end() || !it->second.open) return;
  if (it->second.actor != actor || it->second.session != session) return;
  Cut(&it->second);
}

void EpisodeIndex::Cut(Track* track) {
  track->open = false;
  ++cut_episodes_;
  if (options_.whole_episodes && ring_.Holds(track->last_id)) CompleteEpisode(track->last_id);
}

uint64_t EpisodeIndex::FirstGoalRecord(uint64_t id) const {
  while (ring_.Slot(id).prev != 0) {
    id = Previous(id);
    if (id == 0) return 0;
  }
  return ring_.Header(id).kind == RecordKind::kGoal ? id : 0;
}

uint64_t EpisodeIndex::GoalRecord(uint64_t id) const {
  CHECK(options_.goal_pictures && Sampleable(id)) << "record " << id;
  return oldest_needed_[Slot(id)];
}

uint64_t EpisodeIndex::OldestNeeded(uint64_t first) const {
  if (options_.goal_pictures) return FirstGoalRecord(first);
  uint64_t oldest = first;
  for (int k = 0; k < options_.stack; ++k) {
    const uint64_t prev = ring_.Slot(oldest).prev;
    if (prev == 0 && k > 0) break;  // `oldest` is the reset, which the stack repeats
    if (prev >= oldest || !ring_.Holds(prev)) return 0;
    oldest = prev;
  }
  return oldest;
}

bool EpisodeIndex::Sampleable(uint64_t id) const {
  if (!ring_.Holds(id)) return false;
  const uint64_t oldest = oldest_needed_[Slot(id)];
  return oldest != 0 && oldest >= ring_.oldest_id();
}

}  // namespace shoal::replay
