// SPDX-License-Identifier: Apache-2.0
// Index of the ring: successor of each record, and the steps that can be sampled.
//
// The id of a sample is that of its first step s. The sample consists of the steps s, next(s), ...:
// n = n_step steps, or fewer if one of the steps terminated the episode. The observation of the
// sample is the stack of the K frames that end at prev(s). A sample can be drawn if and only if
//
//   - its last step is stored,
//   - its episode has ended (only with `whole_episodes`), and
//   - prev(s) and the K - 1 records before prev(s) (fewer if the episode has fewer) are in the
//   ring.
//
// If the run has goal pictures, an episode begins with a goal record, followed by its reset. A
// sample then also needs the goal record, which is the oldest record that the sample needs.
//
// An episode is terminated, truncated, or cut. It is cut if its next record never arrived.
//
// The ring overwrites its oldest record first. A sample can therefore be drawn from the time at
// which its last step is stored until the oldest record that the sample needs is overwritten. Each
// slot counts the steps for which its record is this oldest record. If the record is overwritten,
// this number of steps is removed. The number of sampleable steps is therefore exact after every
// record, without a search.
//
// Starts no threads; not thread-safe, one owner. Memory: 20 bytes per slot.
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
  // Borrows the ring and reads its records. Calls `progress`, unless it is empty, for each record.
  // If the ring is a snapshot, skips records that were overwritten during the reading.
  EpisodeIndex(const Ring& ring, const IndexOptions& options, const StartupProgress& progress = {});

  // Reports all samples that can be drawn now to `selector`, and from then on every sample that
  // becomes available or unavailable. Borrows the selector until the next call; nullptr: no
  // selector.
  void SetSelector(Selector* selector);

  // Bytes of memory for a ring of `capacity` records.
  static constexpr uint64_t Bytes(uint64_t capacity) {
    return capacity * (2 * sizeof(uint64_t) + sizeof(uint32_t));
  }

  // The predecessor of a record of this actor session. Returns 0 for the first record of an
  // episode, and the id of the environment's last stored record if `header` continues the same
  // episode. Otherwise returns empty.
  std::optional<uint64_t> Predecessor(uint32_t actor, uint64_t session,
                                      const RecordHeader& header) const;
  // Call this function after each Ring::Append, with the id that Append returned.
  void Added(uint64_t id);
  // Call this function if a record of `env` is missing. The open episode of `env` then ends with
  // its last stored record.
  void Close(uint32_t actor, uint64_t session, uint32_t env);

  // Whether the sample that begins with step `id` can be drawn.
  bool Sampleable(uint64_t id) const;
  // The record that follows, or precedes, record `id` in its episode; 0 if the ring has no such
  // record. The ring must contain `id`.
  uint64_t Next(uint64_t id) const { return next_[Slot(id)]; }
  uint64_t Previous(uint64_t id) const;
  // The goal record of the episode of a sampleable step, in runs with goal pictures.
  uint64_t GoalRecord(uint64_t id) const;
  // Number of sampleable steps.
  uint64_t sampleable() const { return sampleable_; }
  // Number of steps that became sampleable since construction.
  uint64_t became_sampleable() const { return became_sampleable_; }
  // Number of steps that were added since construction and have not become sampleable. Some of them
  // wait for a later record, others never become sampleable. A step that was stored before
  // construction and became sampleable afterwards reduces this number by one.
  uint64_t unsampleable() const { return steps_ - std::min(steps_, became_sampleable_); }
  // Number of episodes that were cut since construction. A cut is detected when the next episode
  // begins or a record is missing.
  uint64_t cut_episodes() const { return cut_episodes_; }

 private:
  // State of an environment.
  struct Track {
    uint64_t session = 0;
    uint64_t last_id = 0;
    uint32_t actor = 0;
    uint32_t episode = 0;
    uint32_t index = 0;
    RecordKind kind = RecordKind::kReset;  // kind of the last record
    bool open = false;                     // whether a step may follow
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
  // Removes the record `gone`, which has been overwritten.
  void Forget(uint64_t gone);
  void Follow(uint64_t id);
  // Ends the open episode at the track's last record.
  void Cut(Track* track);
  // The oldest record that the sample beginning with step `first` needs; 0 if that record has been
  // overwritten.
  uint64_t OldestNeeded(uint64_t first) const;
  // The goal record of the episode of `id`; 0 if this record has been overwritten or does not
  // exist.
  uint64_t FirstGoalRecord(uint64_t id) const;

  const Ring& ring_;
  const IndexOptions options_;
  Selector* selector_ = nullptr;
  std::unordered_map<uint32_t, Track> tracks_;  // by env
  std::vector<uint64_t> next_;                  // by slot: successor; 0 = no successor yet
  std::vector<uint64_t> oldest_needed_;         // by slot: see OldestNeeded; 0 = not sampleable
  std::vector<uint32_t> needed_by_;  // by slot: number of steps whose oldest_needed_ is this record
  uint64_t sampleable_ = 0, became_sampleable_ = 0, cut_episodes_ = 0;
  uint64_t steps_ = 0;  // steps added since construction
};

}  // namespace shoal::replay
