// SPDX-License-Identifier: Apache-2.0
// Lockstep: one actor and the learner take turns, so that a run repeats bit for bit.
//
// With E environments, L = lockstep_steps and B = learner.batch, phase p (0, 1, ...) is
//   1. vector steps of the actor: S0 in phase 0 (replay.min_size / E, rounded up to a multiple of
//   L),
//      L in every later one; then
//   2. updates of the learner until LockstepUpdatesAtPhaseEnd(p), drawn from exactly these steps;
//   then
//   3. the actor takes the weights of that update and phase p + 1 begins.
// Phase 0 has no updates: its end only fixes what the ring holds when learning starts.
//
// What the two sides must keep for this to be exact: a vector step makes E step records; an
// episode's reset record is made at the start of the vector step that follows the episode's end,
// never behind the last step of a phase; the actor sends everything before it waits; the replay
// serves a request once SampleRequest::after_steps step records are stored; request u is that of
// update u.
#pragma once

#include <cstdint>

#include "common/config/config.h"

namespace shoal {

// Vector steps the actor has done since the run's start when phase `phase` >= 0 ends.
int64_t LockstepVectorStepsAtPhaseEnd(const Config& config, int64_t phase);

// Updates the learner has done when phase `phase` ends: floor(phase * r), with
// r = s * L * E / B updates per phase (1 without a limit), s the mean of samples_per_insert over
// the env steps from the end of phase 0 to that of this one. Rounded over the whole run and not per
// phase, so that samples per insert is kept for any L, E and B.
uint64_t LockstepUpdatesAtPhaseEnd(const Config& config, int64_t phase);

// Step records that must be stored before the batch of update `update` >= 1 is drawn.
uint64_t LockstepStepsBeforeUpdate(const Config& config, uint64_t update);

// Where a run ends: with the first phase at whose end config.env_steps steps are stored. Its steps
// and its last update: none is told to drain before those, nor asks for a batch beyond, so that
// where a run ends does not depend on timing.
uint64_t LockstepEnvSteps(const Config& config);
uint64_t LockstepLastUpdate(const Config& config);

}  // namespace shoal
