// SPDX-License-Identifier: Apache-2.0
#include "actor/acting/action_selector.h"

#include <fmt/core.h>

namespace shoal::actor {
namespace {

// A learner on a GPU may compute in bf16 although this CPU cannot.
nn::Precision ActingPrecision(const LearnerConfig& learner, const ObservationSpec& spec) {
  const bool other = learner.device != "cpu" && learner.precision == "bf16";
  return nn::ChoosePrecision(other ? "auto" : learner.precision, spec.HasPixels());
}

}  // namespace

ActionSelector::ActionSelector(const Config& config, const ObservationSpec& spec, int envs,
                               uint32_t actor)
    : envs_(envs),
      action_size_(spec.action_size),
      vector_size_(spec.VectorSize()),
      stack_bytes_(spec.InputBytes()),
      policy_(config.network, spec, ActingPrecision(config.learner, spec), envs),
      exploration_(MakeExploration(config, envs, spec.action_size, NoiseFactor(config, actor))),
      streams_(size_t(envs), Random(0)),
      frames_(size_t(envs) * stack_bytes_),
      vectors_(size_t(envs) * vector_size_),
      actions_(size_t(envs) * action_size_),
      drawn_(spec.drawn_actions ? actions_.size() : 0),
      log_probs_(size_t(envs)) {}

void ActionSelector::Load(const ReceivedWeights& weights) {
  const std::string source = fmt::format("weights of update {}", weights.version.update);
  policy_.Load(weights.payload, source);
  version_ = weights.version;
  run_env_steps_ = weights.env_steps;
  exploration_->OnEnvSteps(run_env_steps_);
}

void ActionSelector::BeginEpisode(int e, uint64_t stream_key) {
  streams_[size_t(e)] = Random(stream_key);
  exploration_->BeginEpisode(e);
}

ActionSelector::Noise ActionSelector::NoiseOf(int e) const {
  return {streams_[size_t(e)].state(), exploration_->StateOf(e)};
}

void ActionSelector::SetNoise(int e, const Noise& noise) {
  streams_[size_t(e)].set_state(noise.stream);
  exploration_->SetState(e, noise.carried);
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

std::span<const float> ActionSelector::DrawnOf(int e) const {
  if (drawn_.empty()) return {};
  return std::span(drawn_).subspan(size_t(e) * action_size_, size_t(action_size_));
}

void ActionSelector::Select(Acting acting, const std::vector<bool>& asked) {
  if (version_.session == 0) acting = Acting::kUniform;
  nn::PolicyOutput all;
  if (acting != Acting::kUniform) all = policy_.Forward(envs_, frames_.data(), vectors_.data());
  const auto size = size_t(action_size_);
  for (int e = 0; e < envs_; ++e) {
    if (!asked.empty() && !asked[size_t(e)]) continue;
    const size_t at = size_t(e) * size;
    nn::PolicyOutput output;
    if (!all.mean.empty()) output.mean = all.mean.subspan(at, size);
    if (!all.log_std.empty()) output.log_std = all.log_std.subspan(at, size);
    const std::span<float> action = std::span(actions_).subspan(at, size);
    Random& stream = streams_[size_t(e)];
    switch (acting) {
      case Acting::kUniform:
        ActAtRandom(stream, action);
        break;
      case Acting::kExplore:
        exploration_->Act(e, output, stream, action);
        if (!drawn_.empty()) {
          log_probs_[size_t(e)] = exploration_->Drawn(std::span(drawn_).subspan(at, size));
        }
        break;
      case Acting::kMean:
        output.squashed = all.squashed;
        nn::MeanActions(output, action);
        break;
    }
  }
}

}  // namespace shoal::actor
