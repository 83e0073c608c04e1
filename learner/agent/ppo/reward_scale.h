// SPDX-License-Identifier: Apache-2.0
// Scales rewards by the running deviation of their discounted returns.
//
// Source: VecNormalize of Stable-Baselines3, common/vec_env/vec_normalize.py.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "common/nn/safetensors.h"
#include "learner/agent/running_moments.h"

namespace shoal::learner {

// Scales rewards r to r', with the returns G so far in the episode:
//
//   r' = clip(r / sqrt(Var(G) + 1e-8), -10, 10),   G_t = discount G_{t-1} + r_t
//
// G starts at 0 in each episode.
class RewardScale {
 public:
  explicit RewardScale(double discount) : discount_(discount) {}

  // Adds the rewards of a rollout of N rows to the statistics and returns the scaled rewards (N).
  // `ends` (N): 1 if an episode ended in this step; `env` (N): the environment of each step. If an
  // episode continues in the next rollout, its return G continues too.
  std::vector<float> Scale(std::span<const float> reward, std::span<const float> ends,
                           std::span<const uint64_t> env);

  // Writes tensors "reward.moments", "reward.envs", "reward.returns".
  void Export(nn::TensorMap* tensors) const;
  void Import(const nn::TensorMap& tensors, const std::string& source);

 private:
  double discount_;
  RunningMoments returns_{1};
  std::map<uint64_t, double> running_;  // G by environment
};

}  // namespace shoal::learner
