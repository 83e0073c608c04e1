// SPDX-License-Identifier: Apache-2.0
// Lockstep: one actor and the learner take turns, so that a run repeats bit for bit.
//
// Let E be the number of environments, L = lockstep_steps and B = learner.batch. Phase p (0, 1,
// ...) consists of
//   1. vector steps of the actor: S0 in phase 0 (replay.min_size / E, rounded up to a multiple of
//      L), L in every later phase;
//   2. updates of the learner until LockstepUpdatesAtPhaseEnd(p), drawn from exactly these steps;
//   3. the change of the actor to the weights of the last update. Then phase p + 1 begins.
// Phase 0 has no updates: its end only fixes the content of the ring when learning starts.
//
// Both sides must obey these rules for a run to be exact:
// - A vector step makes E step records. The reset record of an episode is made at the start of the
//   vector step that follows the end of the episode before, never after the last step of a phase.
// - The actor sends everything before it waits.
// - The replay serves a request once SampleRequest::after_steps step records are stored. Request u
//   belongs to update u.
#pragma once

#include <cstdint>

#include "common/config/config.h"

namespace shoal {

// Vector steps the actor has done since the run's start when phase `phase` >= 0 ends.
int64_t LockstepVectorStepsAtPhaseEnd(const Config& config, int64_t phase);

// Updates the learner has done when phase `phase` ends: floor(phase * r), with r = s * L * E / B
// updates per phase (r = 1 without a limit). s is the mean of samples_per_insert over the env steps
// from the end of phase 0 to the end of this phase. The number is rounded over the whole run and
// not per phase, so that samples_per_insert is exact for any L, E and B.
uint64_t LockstepUpdatesAtPhaseEnd(const Config& config, int64_t phase);

// Step records that must be stored before the batch of update `update` >= 1 is drawn.
uint64_t LockstepStepsBeforeUpdate(const Config& config, uint64_t update);

// End of a run, in env steps and in updates: the end of the first phase after which at least
// config.env_steps steps are stored. No process drains before this point, and the learner requests
// no batch beyond it, so that the end of a run does not depend on timing.
uint64_t LockstepEnvSteps(const Config& config);
uint64_t LockstepLastUpdate(const Config& config);

}  // namespace shoal
