// SPDX-License-Identifier: Apache-2.0
#include "actor/loop/pace.h"

#include <fmt/core.h>

#include <algorithm>

#include "common/base/check.h"
#include "common/config/lockstep.h"
#include "common/config/on_policy.h"

namespace shoal::actor {

LockstepPace::LockstepPace(const Config& config, int64_t vector_steps) : config_(config) {
  while (LockstepVectorStepsAtPhaseEnd(config_, phase_) < vector_steps) ++phase_;
  if (phase_ > 0) update_ = LockstepUpdatesAtPhaseEnd(config_, phase_ - 1);
}

Pace::Turn LockstepPace::Next(int64_t vector_steps, const WeightsVersion& version) {
  if (vector_steps >= LockstepVectorStepsAtPhaseEnd(config_, phase_)) {
    update_ = LockstepUpdatesAtPhaseEnd(config_, phase_);
    if (version.update < update_) return Turn::kAwaitWeights;
    ++phase_;
  } else if (version.update < update_) {
    return Turn::kAwaitWeights;
  }
  // The actor rests only between two phases: if the budget is reached within a phase, the phase is
  // completed.
  const bool at_phase_start =
      phase_ > 0 && vector_steps == LockstepVectorStepsAtPhaseEnd(config_, phase_ - 1);
  const bool budget_reached = vector_steps * config_.envs_per_actor >= config_.env_steps;
  return at_phase_start && budget_reached ? Turn::kRest : Turn::kStep;
}

std::string LockstepPace::Awaited() const {
  return fmt::format("lockstep: no weights of update {}", update_);
}

VersionPace::VersionPace(int64_t vector_steps, int ahead)
    : length_(vector_steps), ahead_(static_cast<uint64_t>(ahead)) {
  CHECK(vector_steps > 0 && ahead >= 0) << vector_steps << " " << ahead;
}

Pace::Turn VersionPace::Next(int64_t vector_steps, const WeightsVersion& version) {
  if (vector_steps < end_) return Turn::kStep;
  if (version.session == 0) return Turn::kAwaitWeights;
  if (version.session != session_) {
    session_ = version.session;
    next_update_ = version.update;
  }
  next_update_ = std::max(next_update_, version.update);
  if (version.update + ahead_ < next_update_) return Turn::kAwaitWeights;
  ++next_update_;
  end_ = vector_steps + length_;
  return Turn::kStep;
}

std::string VersionPace::Awaited() const {
  return fmt::format("no weights of update {}", next_update_ - std::min(next_update_, ahead_));
}

std::unique_ptr<Pace> MakePace(const Config& config, int64_t vector_steps) {
  if (LearnsOnPolicy(config)) {
    return std::make_unique<VersionPace>(config.ppo.rollout_steps, config.ppo.versions_ahead);
  }
  if (config.lockstep) return std::make_unique<LockstepPace>(config, vector_steps);
  return std::make_unique<FreePace>();
}

}  // namespace shoal::actor
