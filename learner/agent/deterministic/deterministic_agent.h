// SPDX-License-Identifier: Apache-2.0
// The common part of TD3 and DDPG: a deterministic actor, which is trained by the critic's
// gradient; targets of actor and critic; and the update with one batch. Equations are numbered in
// docs/algorithm.md.
//
//   1. targets   next_obs -> encoder -> target actor, target critic -> y           (Eq. 18, 15)
//   2. critic    obs -> encoder -> critic -> loss -> encoder and critic step            (Eq. 6)
//   3. actor     the features of 2, detached -> actor -> first critic -> actor step    (Eq. 19)
//   4. targets of actor and critic follow                                               (Eq. 9)
//   5. the averaged policy follows encoder and actor                                   (Eq. 12)
//
// Step 3 runs in every actor_period-th update, and step 4 in every target_period-th update. Updates
// are counted from 1, so the first updates may train only the critic. As in SAC, only the critic's
// loss trains the encoder, and the encoder has no target. With batch normalisation, the encoder
// uses running statistics in step 1, and statistics of the batch in steps 2 and 3.
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
  int critics = 2;  // number of Q functions; a target uses the smallest of their target values
  // Standard deviation of the noise on a target's action (0 for no noise), and the bound to which
  // the noise is clipped.
  double target_noise = 0, target_noise_clip = 0;
};

// Metrics of an update, in the order of its report. The actor's metrics exist only if the update
// trains the actor. The last two metrics exist only if there is a second critic.
inline constexpr const Figure* kTwinFigures[] = {
    &kCriticLoss, &kQMean,         &kTargetMean,       &kCriticGradNorm,
    &kActorLoss,  &kActorGradNorm, &kActionSaturation, &kLearningRate,
    &kQ1Mean,     &kQ1Std,         &kQMinMean,         &kQMinStd,
    &kQMinMin,    &kQMinMax,       &kQ2Mean,           &kQ2Std};
inline constexpr std::span<const Figure* const> kSingleCriticFigures =
    std::span(kTwinFigures).first(std::size(kTwinFigures) - 2);

// Makes the agent, which borrows the engine. `config` gives seed, discount, reward scale, rates and
// periods.
std::unique_ptr<Agent> MakeDeterministicAgent(const Config& config, const ObservationSpec& spec,
                                              const DeterministicOptions& options, Engine* engine);

}  // namespace shoal::learner
