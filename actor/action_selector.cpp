#include "actor/action_selector.h"

#include <fmt/core.h>

#include <cmath>

namespace shoal::actor {

ActionSelector::ActionSelector(const Config& config, const ObservationSpec& spec, int envs)
    : envs_(envs),
      action_size_(spec.action_size),
      vector_size_(spec.VectorSize()),
      stack_bytes_(spec.FrameBytes() * spec.stack),
      policy_(config.network, spec, nn::ChoosePrecision(config.learner.precision), envs),
      noise_(size_t(envs), Random(0)),
      frames_(size_t(envs) * stack_bytes_),
      vectors_(size_t(envs) * vector_size_),
      mean_(size_t(envs) * action_size_),
      log_std_(mean_.size()),
      actions_(mean_.size()) {}

void ActionSelector::Load(const ReceivedWeights& weights) {
  const std::string source = fmt::format("weights of update {}", weights.version.update);
  policy_.Load(nn::ReadSafetensors(weights.payload, source), source);
  version_ = weights.version;
}

std::span<uint8_t> ActionSelector::FrameStackOf(int e) {
  return std::span(frames_).subspan(size_t(e) * stack_bytes_, size_t(stack_bytes_));
}

std::span<float> ActionSelector::VectorOf(int e) {
  return std::span(vectors_).subspan(size_t(e) * vector_size_, size_t(vector_size_));
}

std::span<const float> ActionSelector::ActionOf(int e) const {
  return std::span(actions_).subspan(size_t(e) * action_size_, size_t(action_size_));
}

void ActionSelector::Select(bool deterministic) {
  const bool random = version_.session == 0;
  if (!random)
    policy_.Forward(envs_, frames_.data(), vectors_.data(), mean_.data(), log_std_.data());
  for (int e = 0; e < envs_; ++e) {
    Random& noise = noise_[size_t(e)];
    for (int a = 0; a < action_size_; ++a) {
      const size_t i = size_t(e) * action_size_ + a;
      if (random) {
        actions_[i] = static_cast<float>(noise.Uniform(-1.0, 1.0));
      } else if (deterministic) {
        actions_[i] = std::tanh(mean_[i]);
      } else {
        actions_[i] =
            std::tanh(mean_[i] + std::exp(log_std_[i]) * static_cast<float>(noise.Normal()));
      }
    }
  }
}

}  // namespace shoal::actor
