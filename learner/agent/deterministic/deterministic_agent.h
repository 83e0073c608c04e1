// SPDX-License-Identifier: Apache-2.0
// The common part of TD3, DDPG and DrQ-v2: a deterministic actor, which is trained by the critic's
// gradient; targets of critic and actor; and the update with one batch. Equations are numbered in
// docs/algorithm.md.
//
//   1. targets   next_obs -> encoder -> target actor, target critic -> y       (Eq. 18, 31, 15)
//   2. critic    obs -> encoder -> critic -> loss -> encoder and critic step            (Eq. 6)
//   3. actor     the features of 2, detached -> actor -> critic -> actor step      (Eq. 19, 32)
//   4. targets of actor and critic follow                                               (Eq. 9)
//   5. the averaged policy follows encoder and actor                                   (Eq. 12)
//
// DrQ-v2 has no target actor: the actor itself chooses the actions of step 1. In steps 1 and 3 the
// actions may have noise, whose deviation follows a schedule.
//
// Step 3 runs in every actor_period-th update, and step 4 in every target_period-th update. Updates
// are counted from 1, so the first updates may train only the critic. As in SAC, only the critic's
// loss trains the encoder, and the encoder has no target. With batch normalisation, the encoder
// uses running statistics in step 1, and statistics of the batch in steps 2 and 3.
//
// Sources: Lillicrap et al. 2015, arXiv:1509.02971; Fujimoto et al. 2018, arXiv:1802.09477; Yarats
// et al. 2021, arXiv:2107.09645.
#pragma once

#include <memory>
#include <span>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent.h"
#include "learner/agent/critic_rows.h"
#include "learner/agent/sample_figures.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

struct DeterministicOptions {
  int critics = 2;  // number of Q functions; a target uses the smallest of their target values
  int actor_critics = 1;     // the actor's loss uses the smallest value of the first Q functions
  bool target_actor = true;  // false: the actor itself chooses a target's action
  // Standard deviation of the noise on a target's action (0 for no noise), and the bound to which
  // the noise is clipped.
  Schedule noise = Schedule::Constant(0);
  double noise_clip = 0;
  bool noisy_actor_loss = false;  // the action of the actor's loss has the same noise
};

// Metrics of an update, in the order of its report. The actor's metrics exist only if the update
// trains the actor, kImportanceWeight only if there are such weights. The last two metrics exist
// only if there is a second critic.
inline constexpr const Figure* kTwinFigures[] = {
    &kCriticLoss, &kQMean,         &kTargetMean,       &kCriticGradNorm,
    &kActorLoss,  &kActorGradNorm, &kActionSaturation, &kLearningRate,
    &kQ1Mean,     &kQ1Std,         &kQMinMean,         &kQMinStd,
    &kQMinMin,    &kQMinMax,       &kImportanceWeight, &kQ2Mean,
    &kQ2Std};
inline constexpr std::span<const Figure* const> kSingleCriticFigures =
    std::span(kTwinFigures).first(std::size(kTwinFigures) - 2);

// Makes the agent, which borrows the engine. `config` gives seed, discount, reward scale, rates and
// periods.
std::unique_ptr<Agent> MakeDeterministicAgent(const Config& config, const ObservationSpec& spec,
                                              const DeterministicOptions& options, Engine* engine);

}  // namespace shoal::learner
