// SPDX-License-Identifier: Apache-2.0
// From what a policy says to the action that is played: exploration, apart from the policy and from
// the pace. All draws of an episode come from that episode's own stream.
//
//   squashed_gaussian   a = tanh(mean + f exp(log_std) eps)           Eq. 4 of docs/algorithm.md
//   gaussian            a = clip(tanh(mean) + f sigma eps, -1, 1)
//   ou                  a = clip(tanh(mean) + x_t, -1, 1),
//                       x_t = x_{t-1} (1 - theta dt) + f sigma sqrt(dt) eps,   x = 0 at a reset
//
//   policy              u = mean + exp(log_std) eps,   a = clip(u, -1, 1)
//                       log pi(u) = sum_j -eps_j^2 / 2 - log_std_j - log(2 pi) / 2       (Eq. 22)
//
// eps ~ N(0, I); sigma follows a schedule over the run's env steps; f is the actor's own factor.
// ou: Ornstein-Uhlenbeck noise as in Lillicrap et al. 2015, arXiv:1509.02971, section 7.
//
// Dimensions: E environments, A actions.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/base/random.h"
#include "common/config/config.h"
#include "common/nn/policy.h"

namespace shoal::actor {

// One thread.
class Exploration {
 public:
  virtual ~Exploration() = default;

  // The env steps of the whole run, for schedules.
  virtual void OnEnvSteps(uint64_t run_env_steps) = 0;
  // Forgets what the noise of environment `e` carried over from its episode before.
  virtual void BeginEpisode(int e) = 0;
  // Writes the action (A) of environment `e`, each in [-1, 1]. `policy`: its rows, (A).
  virtual void Act(int e, const nn::PolicyOutput& policy, Random& stream,
                   std::span<float> action) = 0;
  // Of the last Act, for on-policy learning: the action as drawn, written to `drawn` (A), and its
  // log-probability. Others than `policy` have none, leave it and return 0.
  virtual float Drawn(std::span<float> /*drawn*/) const { return 0; }

  // What BeginEpisode forgets, to go on with it in another process; empty where there is nothing.
  // SetState throws Error when the state is of another kind or size.
  virtual std::vector<double> StateOf(int e) const = 0;
  virtual void SetState(int e, std::span<const double> state) = 0;
};

// For `envs` environments of an actor whose noise is `factor` times that of the configuration.
std::unique_ptr<Exploration> MakeExploration(const Config& config, int envs, int action_size,
                                             double factor);

// exploration.spread's factor of an actor: of N actors they lie geometrically even from 1 / spread
// to spread. Actors beyond the configured ones take turns with those.
double NoiseFactor(const Config& config, uint32_t actor);

// How many of exploration.random_steps an actor plays: they are shared evenly.
uint64_t RandomStepsOfActor(const Config& config);

}  // namespace shoal::actor
