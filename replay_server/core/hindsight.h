// SPDX-License-Identifier: Apache-2.0
// Hindsight relabelling: the goal of a sample is replaced by a goal that the same episode achieved.
//
// Let N = replay.hindsight_goals: a share N / (N + 1) of the samples is relabelled. The goal of a
// sample that begins with step t of an episode whose last step is T is the achieved goal after
//
//   future    a step drawn uniformly from t, ..., T
//   final     step T
//   episode   a step drawn uniformly from the steps 1, ..., T that are still in the ring
//
// The episodes of samples must have ended: use an EpisodeIndex with whole_episodes.
// Source: Andrychowicz et al. 2017, arXiv:1707.01495, sections 3.2 to 4.5.
#pragma once

#include <cstdint>
#include <vector>

#include "common/config/run_config.h"
#include "common/tasks/task.h"
#include "replay_server/core/episode_index.h"
#include "replay_server/core/relabeller.h"
#include "replay_server/core/ring.h"

namespace shoal::replay {

enum class HindsightGoal { kFuture, kFinal, kEpisode };

class HindsightRelabeller final : public Relabeller {
 public:
  // Borrows ring and index. goals_per_sample: N >= 0.
  HindsightRelabeller(const Ring& ring, const EpisodeIndex& index, HindsightGoal kind,
                      int goals_per_sample);

  uint64_t DrawGoal(uint64_t id, Random* random) override;

 private:
  const Ring& ring_;
  const EpisodeIndex& index_;
  const HindsightGoal kind_;
  const double share_;
  std::vector<uint64_t> steps_;  // candidates for the goal in the last DrawGoal
};

// The task of a run, with the run's distance threshold.
tasks::Task TaskOf(const RunConfig& run);

// Throws Error (kUsage) if replay.hindsight cannot be used for the run:
//   - the task has no goals,
//   - actions are repeated (rewards are then sums, which cannot be computed for another goal),
//   - the policy does not observe the desired goal,
//   - the ring is too small for the unfinished episodes,
//   - in lockstep, the learner would wait for a sample that the actor has not made yet.
// Also throws if replay.movement_share is set without hindsight. The actor checks that pictures do
// not show a goal.
void CheckHindsight(const RunConfig& run);

}  // namespace shoal::replay
