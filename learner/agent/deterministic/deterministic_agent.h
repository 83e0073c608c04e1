// SPDX-License-Identifier: Apache-2.0
// The common part of TD3 and DDPG: a deterministic actor that ascends its critic, targets of both,
// and one update of a batch. Equations are numbered in docs/algorithm.md.
//
//   1. targets   next_obs -> encoder -> target actor, target critic -> y           (Eq. 18, 15)
//   2. critic    obs -> encoder -> critic -> loss -> encoder and critic step            (Eq. 6)
//   3. actor     the features of 2, detached -> actor -> first critic -> actor step    (Eq. 19)
//   4. targets of actor and critic follow                                               (Eq. 9)
//   5. the averaged policy follows encoder and actor                                   (Eq. 12)
//
// Step 3 belongs to every actor_period-th update, step 4 to every target_period-th, counted from 1:
// the critic moves first. As in SAC, the encoder is trained by the critic's loss alone and has no
// target. With batch normalisation it uses running statistics in 1, those of the batch in 2 and 3.
//
// Sources: Lillicrap et al. 2015, arXiv:1509.02971; Fujimoto et al. 2018, arXiv:1802.09477.
#pragma once

#include <memory>
#include <span>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent.h"
#include "learner/agent/sample_figures.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

struct DeterministicOptions {
  int critics = 2;  // Q functions; a target is the smallest of them
  // Standard deviation of the noise on a target's action, and what it is clipped to; 0: none.
  double target_noise = 0, target_noise_clip = 0;
};

// In the order of an update. The actor's figures exist only if the update moves the actor; the last
// two need a second critic.
inline constexpr const Figure* kTwinFigures[] = {
    &kCriticLoss, &kQMean,         &kTargetMean,       &kCriticGradNorm,
    &kActorLoss,  &kActorGradNorm, &kActionSaturation, &kLearningRate,
    &kQ1Mean,     &kQ1Std,         &kQMinMean,         &kQMinStd,
    &kQMinMin,    &kQMinMax,       &kQ2Mean,           &kQ2Std};
inline constexpr std::span<const Figure* const> kSingleCriticFigures =
    std::span(kTwinFigures).first(std::size(kTwinFigures) - 2);

// Borrows the engine. Takes seed, discount, reward scale, rates and periods from `config`.
std::unique_ptr<Agent> MakeDeterministicAgent(const Config& config, const ObservationSpec& spec,
                                              const DeterministicOptions& options, Engine* engine);

}  // namespace shoal::learner
