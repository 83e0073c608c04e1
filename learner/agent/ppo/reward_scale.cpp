// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/ppo/reward_scale.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "common/nn/tensor_words.h"

namespace shoal::learner {
namespace {

constexpr double kVarianceEpsilon = 1e-8, kLimit = 10;

}  // namespace

std::vector<float> RewardScale::Scale(std::span<const float> reward, std::span<const float> ends,
                                      std::span<const uint64_t> env) {
  std::vector<float> returns(reward.size());
  for (size_t t = 0; t < reward.size(); ++t) {
    double& running = running_[env[t]];
    running = discount_ * running + double{reward[t]};
    returns[t] = static_cast<float>(running);
    if (ends[t] != 0) running = 0;
  }
  returns_.Add(returns);
  const double factor = 1 / std::sqrt(double{returns_.Variance()[0]} + kVarianceEpsilon);
  std::ranges::transform(reward, returns.begin(), [&](float r) {
    return static_cast<float>(std::clamp(double{r} * factor, -kLimit, kLimit));
  });
  return returns;
}

void RewardScale::Export(nn::TensorMap* tensors) const {
  returns_.Export("reward.moments", tensors);
  std::vector<uint64_t> envs, running;
  for (const auto& [env, value] : running_) {
    envs.push_back(env);
    running.push_back(std::bit_cast<uint64_t>(value));
  }
  (*tensors)["reward.envs"] = nn::WordsTensor(envs);
  (*tensors)["reward.returns"] = nn::WordsTensor(running);
}

void RewardScale::Import(const nn::TensorMap& tensors, const std::string& source) {
  const auto envs = nn::ReadWords(tensors, "reward.envs", std::nullopt, source);
  const auto running = nn::ReadWords(tensors, "reward.returns", envs.size(), source);
  returns_.Import(tensors, "reward.moments", source);
  running_.clear();
  for (size_t i = 0; i < envs.size(); ++i) running_[envs[i]] = std::bit_cast<double>(running[i]);
}

}  // namespace shoal::learner
