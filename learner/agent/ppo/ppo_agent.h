// SPDX-License-Identifier: Apache-2.0
// Proximal policy optimisation: one update learns from a whole rollout. The update makes several
// passes (epochs) over the rollout, in minibatches. Equations are numbered in docs/algorithm.md.
//
//   1. rewards      divided by the running deviation of returns, if configured
//   2. values       computed for every observation, before the first epoch
//   3. advantages   computed together with value targets                       (Eq. 23)
//   4. epochs       minibatches of learner.batch rows, in a new order in each epoch: loss (Eq. 22,
//                   24), gradients clipped to learner.max_grad_norm, one step of Adam with
//                   eps 1e-5; the epochs end early if the policy has moved by more than
//                   1.5 ppo.target_kl
//   5. statistics   the rollout's observations are added to the normalisation statistics. This is
//                   the last step, because the log-probabilities of this rollout were computed with
//                   the old statistics
//
// If the number of rows is not a multiple of learner.batch (a rollout of fewer environments than
// usual), each epoch leaves out the remaining rows. Different epochs leave out different rows.
//
// Sources: Schulman et al. 2017, arXiv:1707.06347. Details follow ppo.py of Stable-Baselines3;
// tests/learner/agent/sb3_ppo_test.cpp compares the two implementations.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "common/base/random.h"
#include "common/config/config.h"
#include "common/spec/observation_spec.h"
#include "learner/agent/agent.h"
#include "learner/engine/engine.h"

namespace shoal::learner {

inline constexpr Figure kValueLoss{"value_loss", "", "squared error of the values", true, ""};
inline constexpr Figure kApproxKl{
    "approx_kl", "nats", "estimated KL divergence of the policy from the one before the update",
    true, ""};
inline constexpr Figure kClipFraction{
    "clip_fraction", "", "share of steps whose probability ratio is clipped", false, ""};
inline constexpr Figure kExplainedVariance{
    "explained_variance", "",
    "share of the returns' variance that the values before the update explain", true, ""};
inline constexpr Figure kDeviation{
    "deviation", "", "standard deviation of the policy, mean over actions", false, "std"};
inline constexpr Figure kGradNorm{"grad_norm", "", "norm of all gradients before clipping", false,
                                  ""};
inline constexpr Figure kClipRange{"clip_range", "", "ppo.clip in force", false, ""};
inline constexpr Figure kMinibatches{"minibatches", "", "optimiser steps of the update", false, ""};
inline constexpr Figure kRolloutSteps{"rollout_steps", "env steps",
                                      "env steps that the update learned from", false, ""};
inline constexpr Figure kRolloutLag{"rollout_lag", "updates",
                                    "updates between the policy that acted and the newest one",
                                    false, ""};

inline constexpr const Figure* kPpoFigures[] = {
    &kActorLoss,    &kValueLoss,  &kEntropy,          &kApproxKl,     &kClipFraction,
    &kGradNorm,     &kDeviation,  &kClipRange,        &kLearningRate, &kMinibatches,
    &kRolloutSteps, &kRolloutLag, &kExplainedVariance};

// Returns the order in which an epoch uses the rows 0 .. rows - 1.
using RowOrder = std::function<std::vector<int>(int rows, Random* random)>;
std::vector<int> ShuffledRows(int rows, Random* random);

// See Algorithm::make. Throws Error (kUsage) if the configuration does not fit.
std::unique_ptr<Agent> MakePpoAgent(const Config& config, const ObservationSpec& spec,
                                    Engine* engine);
// Does the same with a given order of rows, for comparisons with other programs.
std::unique_ptr<Agent> MakePpoAgent(const Config& config, const ObservationSpec& spec,
                                    Engine* engine, RowOrder order);

}  // namespace shoal::learner
