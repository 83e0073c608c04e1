// SPDX-License-Identifier: Apache-2.0
// Index of the ring: successor of each record, and the steps that can be sampled.
//
// A sample is named by its first step s. Its observation is the stack of the K frames that end at
// prev(s). The sample consists of the steps s, next(s), ...: n = n_step steps, or fewer if one of
// the steps terminated the episode. A sample can be drawn if and only if
//
//   - its last step is stored,
//   - its episode has ended (only with `whole_episodes`), and
//   - prev(s) and the K - 1 records before it are in the ring, as far as the episode has them.
//
// If the run has goal pictures, an episode begins with a goal record, followed by its reset. A
// sample then also needs the goal record, which is the oldest record that the sample needs.
//
// An episode ends terminated, truncated, or cut: closed because its next record never arrived.
//
// The ring drops its oldest record first, so s can be sampled from the moment its last step is
// stored until the oldest record that the sample needs is overwritten. Each slot counts the steps
// for which its record is this oldest one; overwriting the record removes that many steps at once.
// The number of sampleable steps is therefore exact after every record, without a search.
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
  bool whole_episodes = false;  // samples only episodes that have ended
  bool goal_pictures = false;   // episodes begin with a goal record
};

class EpisodeIndex {
 public:
  // Borrows the ring and reads its records; calls `progress`, unless it is empty, for each record.
  // Records of a snapshot that were overwritten meanwhile are skipped.
  EpisodeIndex(const Ring& ring, const IndexOptions& options, const StartupProgress& progress = {});

  // Reports every sample that becomes available or unavailable to `selector`, beginning with those
  // that are available now. Borrows the selector until the next call; nullptr: no selector.
  void SetSelector(Selector* selector);

  // Bytes of memory for a ring of `capacity` records.
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

  // `id`: the first step of the sample.
  bool Sampleable(uint64_t id) const;
  // The record that follows or precedes record `id` in its episode; 0 if there is none in the ring.
  // The ring must hold `id`.
  uint64_t Next(uint64_t id) const { return next_[Slot(id)]; }
  uint64_t Previous(uint64_t id) const;
  // The goal record of the episode of a sampleable step, in runs with goal pictures.
  uint64_t GoalRecord(uint64_t id) const;
  uint64_t sampleable() const { return sampleable_; }
  // How often a step became sampleable since construction.
  uint64_t became_sampleable() const { return became_sampleable_; }
  // Steps added since construction that are not sampleable: some wait for a later record, others
  // never become sampleable. Each step that was stored before construction and became sampleable
  // since reduces this count by one.
  uint64_t unsampleable() const { return steps_ - std::min(steps_, became_sampleable_); }
  // Episodes that ended neither terminated nor truncated, since construction. Such an end is
  // detected when the next episode begins or a record is missing.
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

  // Whether the record continues the episode whose newest record is `last`, by kind and index.
  static bool Follows(const RecordHeader& header, const Track& last);
  size_t Slot(uint64_t id) const { return static_cast<size_t>(id % ring_.capacity()); }
  // Makes the samples that end with step `id` sampleable: the sample of n steps and, if step `id`
  // terminated the episode, the shorter samples.
  void Complete(uint64_t id);
  // Calls MakeSampleable for every step of the episode that ended with step `last`, for
  // whole_episodes.
  void CompleteEpisode(uint64_t last);
  void MakeSampleable(uint64_t first);
  // Record `gone` has been overwritten.
  void Forget(uint64_t gone);
  void Follow(uint64_t id);
  // The episode that was open ends at the track's last record.
  void Cut(Track* track);
  // The oldest record that the sample beginning with step `first` needs; 0 if that record has been
  // overwritten.
  uint64_t OldestNeeded(uint64_t first) const;
  // The first record of the episode of `id`; 0 if that record has been overwritten or is no goal
  // record.
  uint64_t FirstGoalRecord(uint64_t id) const;

  const Ring& ring_;
  const IndexOptions options_;
  Selector* selector_ = nullptr;
  std::unordered_map<uint32_t, Track> tracks_;  // by env
  std::vector<uint64_t> next_;                  // by slot; 0 = no record follows (yet)
  std::vector<uint64_t> oldest_needed_;         // by slot; 0 = not a sample's first step (yet)
  std::vector<uint32_t> needed_by_;             // by slot: sampleable steps whose oldest it is
  uint64_t sampleable_ = 0, became_sampleable_ = 0, cut_episodes_ = 0;
  uint64_t steps_ = 0;  // added since construction
};

}  // namespace shoal::replay
