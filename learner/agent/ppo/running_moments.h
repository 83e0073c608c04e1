// Mean and variance of all vectors seen so far, taken over batch by batch, and the discounted
// returns by whose deviation rewards are scaled.
//
// Sources: Chan et al. 1983, "Algorithms for computing the sample variance"; VecNormalize of
// Stable-Baselines3.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "common/nn/safetensors.h"

namespace shoal::learner {

// Of vectors of V numbers. One thread.
class RunningMoments {
 public:
  explicit RunningMoments(int size);

  // rows (N, V).
  void Add(std::span<const float> rows);

  double count() const { return count_; }
  // (V) f32: 0 and 1 before any vector.
  std::vector<float> Mean() const;
  std::vector<float> Variance() const;

  // As tensor `name` of 1 + 2V doubles, bit for bit (U64).
  void Export(const std::string& name, nn::TensorMap* tensors) const;
  // Throws Error naming the tensor that is missing or of another shape; nothing has changed then.
  void Import(const nn::TensorMap& tensors, const std::string& name, const std::string& source);

 private:
  double count_ = 0;
  std::vector<double> mean_, squares_;  // (V): mean; sum of squared distances from it
};

// r' = clip(r / sqrt(Var(G) + 1e-8), -10, 10),   G_t = discount G_{t-1} + r_t, from 0 in each
// episode
class RewardScale {
 public:
  explicit RewardScale(double discount) : discount_(discount) {}

  // Takes the rewards (N) of a rollout over and scales them. `ends` (N): 1 where an episode ended;
  // `env` (N): whose steps they are. Returns go on from rollout to rollout.
  std::vector<float> Scale(std::span<const float> reward, std::span<const float> ends,
                           std::span<const uint64_t> env);

  // Tensors "reward.moments", "reward.envs", "reward.returns".
  void Export(nn::TensorMap* tensors) const;
  void Import(const nn::TensorMap& tensors, const std::string& source);

 private:
  double discount_;
  RunningMoments returns_{1};
  std::map<uint64_t, double> running_;  // G by environment
};

}  // namespace shoal::learner
