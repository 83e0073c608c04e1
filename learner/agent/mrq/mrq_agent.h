// SPDX-License-Identifier: Apache-2.0
// MR.Q: a model of latent states is trained to predict the next steps, and a deterministic policy
// and its critics read the states of this model. Equations are numbered in docs/algorithm.md.
//
//   1. model     obs -> encoder -> z; z and the actions of H steps -> predictions -> loss (Eq. 37)
//   2. targets   next_obs -> target encoder -> target policy, target critics -> y       (Eq. 38)
//   3. critic    obs -> held encoder -> z; z and action -> critics -> loss              (Eq. 34)
//   4. policy    z -> policy -> critics -> step                                         (Eq. 39)
//   5. every mrq.period updates: the targets become copies of the held encoder, the policy and the
//      critics, and the held encoder becomes a copy of the trained one
//
// "Encoder" here means the network from observation to state, and the model. The critics' loss and
// the policy's loss train neither. Actors use the held encoder and the policy.
//
// Source: Fujimoto et al. 2025, arXiv:2501.16142.
#pragma once

#include <memory>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent.h"
#include "learner/agent/critic_rows.h"
#include "learner/agent/sample_figures.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

inline constexpr Figure kModelLoss{.name = "model_loss",
                                   .unit = "",
                                   .meaning = "loss of the latent model, summed over the steps",
                                   .headline = true,
                                   .known_as = ""};
inline constexpr Figure kStateError{
    "state_error", "", "mean square error of the predicted latent states, summed over the steps",
    false, ""};
inline constexpr Figure kRewardError{
    "reward_error", "nats", "cross-entropy of the predicted rewards, summed over the steps", false,
    ""};
inline constexpr Figure kEndError{
    "end_error", "", "mean square error of the predicted ends, summed over the steps", false, ""};
inline constexpr Figure kModelGradNorm{"model_grad_norm", "", "norm of the model's gradient", false,
                                       ""};
inline constexpr Figure kRewardScale{
    "reward_scale", "", "mean absolute reward, by which the critics' values are divided", false,
    ""};

// Metrics of an update, in the order of its report. kImportanceWeight exists only if there are such
// weights.
inline constexpr const Figure* kMrqFigures[] = {
    &kModelLoss,    &kStateError,  &kRewardError,     &kEndError,       &kModelGradNorm,
    &kCriticLoss,   &kQMean,       &kTargetMean,      &kCriticGradNorm, &kQ1Mean,
    &kQ1Std,        &kQ2Mean,      &kQ2Std,           &kQMinMean,       &kQMinStd,
    &kQMinMin,      &kQMinMax,     &kActorLoss,       &kActorGradNorm,  &kActionSaturation,
    &kLearningRate, &kRewardScale, &kImportanceWeight};

// See Algorithm::make.
std::unique_ptr<Agent> MakeMrqAgent(const Config& config, const ObservationSpec& spec,
                                    Engine* engine);

}  // namespace shoal::learner
