// SPDX-License-Identifier: Apache-2.0
// Proximal policy optimisation: one update learns from a whole rollout, in several passes over it
// by minibatches. Equations are numbered in docs/algorithm.md.
//
//   1. rewards      divided by the running deviation of returns, where asked for
//   2. values       of every observation, before the update
//   3. advantages   and their targets                                          (Eq. 23)
//   4. epochs       the rows in another order each time, learner.batch at a time: loss (Eq. 22,
//                   24), gradients cut to learner.max_grad_norm, one step of Adam with eps 1e-5;
//                   ended early when the policy has moved by 1.5 ppo.target_kl
//   5. observations of the rollout join the statistics that normalise them, for the policy that
//                   follows: this one's log-probabilities were made with the old ones
//
// Rows that make no whole minibatch (a rollout of fewer environments than usual) are left out of
// an epoch; which ones differs from epoch to epoch.
//
// Sources: Schulman et al. 2017, arXiv:1707.06347; details as ppo.py of Stable-Baselines3, with
// which tests/learner/agent/sb3_ppo_test.cpp compares them.
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
inline constexpr Figure kApproxKl{"approx_kl", "nats", "by how much the policy has moved", true,
                                  ""};
inline constexpr Figure kClipFraction{"clip_fraction", "", "share of steps whose ratio is clipped",
                                      false, ""};
inline constexpr Figure kExplainedVariance{
    "explained_variance", "", "of the returns, by the values before the update", true, ""};
inline constexpr Figure kDeviation{"deviation", "", "of the policy, mean over actions", false,
                                   "std"};
inline constexpr Figure kGradNorm{"grad_norm", "", "norm of all gradients, before it is cut", false,
                                  ""};
inline constexpr Figure kClipRange{"clip_range", "", "ppo.clip in force", false, ""};
inline constexpr Figure kMinibatches{"minibatches", "", "steps of the optimiser", false, ""};
inline constexpr Figure kRolloutSteps{"rollout_steps", "env steps", "the update was made of", false,
                                      ""};
inline constexpr Figure kRolloutLag{"rollout_lag", "updates",
                                    "by which the policy that acted was behind", false, ""};

inline constexpr const Figure* kPpoFigures[] = {
    &kActorLoss,    &kValueLoss,  &kEntropy,          &kApproxKl,     &kClipFraction,
    &kGradNorm,     &kDeviation,  &kClipRange,        &kLearningRate, &kMinibatches,
    &kRolloutSteps, &kRolloutLag, &kExplainedVariance};

// The order in which an epoch goes through `rows` rows.
using RowOrder = std::function<std::vector<int>(int rows, Random* random)>;
std::vector<int> ShuffledRows(int rows, Random* random);

// Throws Error (kUsage) where the configuration does not fit.
std::unique_ptr<Agent> MakePpoAgent(const Config& config, const ObservationSpec& spec,
                                    Engine* engine);
// Same as above with a given order of rows, to compare with other programs.
std::unique_ptr<Agent> MakePpoAgent(const Config& config, const ObservationSpec& spec,
                                    Engine* engine, RowOrder order);

}  // namespace shoal::learner
