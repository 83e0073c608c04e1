// SPDX-License-Identifier: Apache-2.0
// Lockstep: one actor and the learner take turns, so that a run repeats bit for bit.
//
// Let E be the number of environments, L = lockstep_steps and B = learner.batch. Phase p (0, 1,
// ...) consists of
//   1. vector steps of the actor: S0 in phase 0 (replay.min_size / E, rounded up to a multiple of
//      L), L in every later phase;
//   2. updates of the learner until LockstepUpdatesAtPhaseEnd(p), with batches drawn from exactly
//      the steps up to here;
//   3. the change of the actor to the weights of the last update.
// Phase 0 has no updates. Its end determines the content of the ring when learning starts.
//
// A run can be repeated bit for bit only if the processes follow these rules:
// - A vector step makes E step records. The reset record of an episode is made at the start of the
//   vector step that follows the end of the previous episode, never after the last step of a phase.
// - The actor sends all its records before it waits.
// - The replay serves a request after SampleRequest::after_steps step records are stored. Request u
//   belongs to update u.
#pragma once

#include <cstdint>

#include "common/config/config.h"

namespace shoal {

// Number of the actor's vector steps from the run's start to the end of phase `phase` >= 0.
int64_t LockstepVectorStepsAtPhaseEnd(const Config& config, int64_t phase);

// Number of the learner's updates from the run's start to the end of phase `phase`: floor(phase *
// r), with r = s * L * E / B updates per phase (r = 1 without a limit). s is the mean of
// samples_per_insert over the env steps from the end of phase 0 to the end of this phase. Only the
// total is rounded, not the number of each phase, so that samples_per_insert is exact for any L, E
// and B.
uint64_t LockstepUpdatesAtPhaseEnd(const Config& config, int64_t phase);

// Step records that must be stored before the batch of update `update` >= 1 is drawn.
uint64_t LockstepStepsBeforeUpdate(const Config& config, uint64_t update);

// End of a run, in env steps and in updates: the end of the first phase after which at least
// config.env_steps steps are stored. No process begins to stop before this point, and the learner
// requests no batch for a later update, so that the end of a run does not depend on timing.
uint64_t LockstepEnvSteps(const Config& config);
uint64_t LockstepLastUpdate(const Config& config);

}  // namespace shoal
