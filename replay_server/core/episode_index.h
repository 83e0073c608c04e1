// SPDX-License-Identifier: Apache-2.0
// Which record follows which, and which steps can be sampled.
//
//   A sample is known by its first step s: it begins at the observation before s, a stack of the K
//   frames that end at prev(s), and goes on over s, next(s), ..., n = n_step steps in all, or fewer
//   where one of them terminated the episode. It can be drawn iff the last of these is stored, the
//   episode has ended (with `whole_episodes`), and prev(s) and its K - 1 predecessors, or what the
//   episode has of them, are in the ring.
//
//   In runs with goal pictures an episode begins with a goal record, followed by its reset. Each of
//   its samples needs the goal record too, which is then the oldest one.
//
// An episode ends terminated, truncated, or cut: closed because its next record never came.
//
// The ring drops its oldest record first, so s can be sampled from the moment its last step is
// stored until the oldest frame of its stack is overwritten. Each slot counts the steps that need
// its record as their oldest one; overwriting it takes that many away at once. The number of
// sampleable steps is therefore exact after every record, at no search.
//
// Threads: none inside; one owner. Memory: 20 bytes per slot.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "common/spec/record.h"
#include "replay_server/core/ring.h"
#include "replay_server/core/selector.h"

namespace shoal::replay {

struct IndexOptions {
  int stack = 1;                // K
  int n_step = 1;               // n
  bool whole_episodes = false;  // sample nothing of episodes that go on
  bool goal_pictures = false;   // episodes begin with a goal record
};

class EpisodeIndex {
 public:
  // Borrows the ring and reads what is in it, calling `progress` for each record, if there is one;
  // records of a snapshot that vanished are skipped.
  EpisodeIndex(const Ring& ring, const IndexOptions& options, const StartupProgress& progress = {});

  // Told from now on of samples that come and go, and at once of those there are; borrowed until
  // another, or nullptr, takes its place.
  void SetSelector(Selector* selector);

  // Memory it takes for a ring of that many records.
  static constexpr uint64_t Bytes(uint64_t capacity) {
    return capacity * (2 * sizeof(uint64_t) + sizeof(uint32_t));
  }

  // The predecessor of a record of this actor session: 0 for an episode's first record, the id of
  // the environment's last stored record if this record continues the same episode, else empty.
  std::optional<uint64_t> Predecessor(uint32_t actor, uint64_t session,
                                      const RecordHeader& header) const;
  // Call after each Ring::Append, with the id it returned.
  void Added(uint64_t id);
  // A record of `env` is missing: its open episode ends at the last stored one.
  void Close(uint32_t actor, uint64_t session, uint32_t env);

  // `id`: of the sample's first step.
  bool Sampleable(uint64_t id) const;
  // The record that follows or precedes `id`, which the ring holds, in its episode; 0 when none
  // does (yet), or no longer.
  uint64_t Next(uint64_t id) const { return next_[Slot(id)]; }
  uint64_t Previous(uint64_t id) const;
  // The goal record of the episode of a sampleable step, in runs with goal pictures.
  uint64_t GoalRecord(uint64_t id) const;
  uint64_t sampleable() const { return sampleable_; }
  // How often a step became sampleable since construction.
  uint64_t became_sampleable() const { return became_sampleable_; }
  // Steps added since construction that have not become sampleable: those that wait for a later
  // record, and those that never will. A step that was there before and has become so counts
  // against them.
  uint64_t unsampleable() const { return steps_ - std::min(steps_, became_sampleable_); }
  // Episodes that ended neither terminated nor truncated, seen when the next one began or a record
  // was missing. Since construction.
  uint64_t cut_episodes() const { return cut_episodes_; }

 private:
  // State of an environment.
  struct Track {
    uint64_t session = 0;
    uint64_t last_id = 0;
    uint32_t actor = 0;
    uint32_t episode = 0;
    uint32_t index = 0;
    RecordKind kind = RecordKind::kReset;  // of the last record
    bool open = false;                     // a next step may follow
  };

  // The record is the next of an episode that has come as far as `last`, by its kind and index.
  static bool Follows(const RecordHeader& header, const Track& last);
  size_t Slot(uint64_t id) const { return static_cast<size_t>(id % ring_.capacity()); }
  // Makes the samples sampleable whose last step `id` is: that of n steps and, when it terminated
  // the episode, the shorter ones.
  void Complete(uint64_t id);
  // The same for every step of the episode that has ended with `last`, for whole_episodes.
  void CompleteEpisode(uint64_t last);
  void MakeSampleable(uint64_t first);
  // Record `gone` has been overwritten.
  void Forget(uint64_t gone);
  void Follow(uint64_t id);
  // The episode that was open ends at the track's last record.
  void Cut(Track* track);
  // The oldest record that the sample beginning with step `first` needs; 0 when it is gone.
  uint64_t OldestNeeded(uint64_t first) const;
  // The first record of the episode of `id`; 0 when it is gone, or is no goal record.
  uint64_t FirstGoalRecord(uint64_t id) const;

  const Ring& ring_;
  const IndexOptions options_;
  Selector* selector_ = nullptr;
  std::unordered_map<uint32_t, Track> tracks_;  // by env
  std::vector<uint64_t> next_;                  // by slot; 0 = nothing follows (yet)
  std::vector<uint64_t> oldest_needed_;         // by slot; 0 = not a sample's first step (yet)
  std::vector<uint32_t> needed_by_;             // by slot: sampleable steps whose oldest it is
  uint64_t sampleable_ = 0, became_sampleable_ = 0, cut_episodes_ = 0;
  uint64_t steps_ = 0;  // added since construction
};

}  // namespace shoal::replay
