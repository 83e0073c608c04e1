// SPDX-License-Identifier: Apache-2.0
// Exploration: computes the played action from a policy's output. Independent of the policy and of
// the pace. All draws of an episode use the episode's own random stream.
//
//   squashed_gaussian   a = tanh(mean + f exp(log_std) eps)           Eq. 4 of docs/algorithm.md
//   gaussian            a = clip(tanh(mean) + f sigma eps, -1, 1)
//   ou                  a = clip(tanh(mean) + x_t, -1, 1),
//                       x_t = x_{t-1} (1 - theta dt) + f sigma sqrt(dt) eps,   x = 0 at a reset
//
//   policy              u = mean + exp(log_std) eps,   a = clip(u, -1, 1)
//                       log pi(u) = sum_j -eps_j^2 / 2 - log_std_j - log(2 pi) / 2       (Eq. 22)
//
// In a share of the steps, exploration.random_share, the action is uniform in [-1, 1] instead,
// independent of the other steps (not for `policy`).
//
// eps ~ N(0, I); sigma, of ExplorationSigma, follows a schedule over the run's env steps; f is the
// actor's own factor. ou: Ornstein-Uhlenbeck noise as in Lillicrap et al. 2015, arXiv:1509.02971,
// section 7.
//
// Dimensions: E environments, A components of an action.
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

  // Sets the env steps of the whole run, for schedules.
  virtual void OnEnvSteps(uint64_t run_env_steps) = 0;
  // Resets the state that the noise of environment `e` carried over from its previous episode.
  virtual void BeginEpisode(int e) = 0;
  // Writes the action (A) of environment `e`, each component in [-1, 1]. `policy`: the policy's
  // output (A) for this environment.
  virtual void Act(int e, const nn::PolicyOutput& policy, Random& stream,
                   std::span<float> action) = 0;
  // Result of the last Act, for on-policy learning: writes the drawn action to `drawn` (A) and
  // returns its log-probability. Kinds other than `policy` write nothing and return 0.
  virtual float Drawn(std::span<float> /*drawn*/) const { return 0; }

  // The state that BeginEpisode resets, so that another process can continue; empty if there is
  // none. SetState throws Error if the state is of another kind or size.
  virtual std::vector<double> StateOf(int e) const = 0;
  virtual void SetState(int e, std::span<const double> state) = 0;
};

// Writes a uniform random action.
void ActAtRandom(Random& stream, std::span<float> action);

// Makes the exploration of an actor with `envs` environments. `factor` scales the configured noise.
std::unique_ptr<Exploration> MakeExploration(const Config& config, int envs, int action_size,
                                             double factor);

// Factor of an actor by exploration.spread: the factors of N actors form a geometric sequence from
// 1 / spread to spread. Actors beyond the configured number repeat these factors in turn.
double NoiseFactor(const Config& config, uint32_t actor);

// An actor's share of exploration.random_steps, which are divided evenly among the actors.
uint64_t RandomStepsOfActor(const Config& config);

}  // namespace shoal::actor
