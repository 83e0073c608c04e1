// SPDX-License-Identifier: Apache-2.0
// Hindsight relabelling: a sample gets a goal that its own episode achieved, as if the episode had
// aimed at this goal.
//
// Let N = replay.hindsight_goals: a share N / (N + 1) of the samples is relabelled. The goal of a
// sample that begins with step t of an episode whose last step is T is the achieved goal after
//
//   future    a step drawn uniformly from t, ..., T
//   final     step T
//   episode   a step drawn uniformly from the steps 1, ..., T that are still in the ring
//
// Source: Andrychowicz et al. 2017, arXiv:1707.01495, sections 3.2 to 4.5. Episodes must have
// ended: EpisodeIndex with whole_episodes.
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
  // Borrows both. goals_per_sample >= 0: N.
  HindsightRelabeller(const Ring& ring, const EpisodeIndex& index, HindsightGoal kind,
                      int goals_per_sample);

  uint64_t DrawGoal(uint64_t id, Random* random) override;

 private:
  const Ring& ring_;
  const EpisodeIndex& index_;
  const HindsightGoal kind_;
  const double share_;
  std::vector<uint64_t> steps_;  // candidates for the goal, of the episode of the last DrawGoal
};

// The task of a run with the run's threshold.
tasks::Task TaskOf(const RunConfig& run);

// Throws Error (kUsage) if replay.hindsight cannot be used for the run: a task without goals;
// repeated actions (their rewards are sums, which cannot be recomputed for another goal); a policy
// whose observation lacks the desired goal; a ring too small for the unfinished episodes; lockstep
// that would wait for a sample before there is one. Also throws if replay.movement_share is set
// without hindsight. The actor checks that pictures do not show a goal.
void CheckHindsight(const RunConfig& run);

}  // namespace shoal::replay
