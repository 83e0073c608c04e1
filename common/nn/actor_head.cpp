#include "common/nn/actor_head.h"

#include <cmath>

namespace shoal::nn {
namespace {

constexpr float kLogStdLow = -5, kLogStdHalfRange = 3.5f;

}  // namespace

ActorHead::ActorHead(const LayerContext& context, const NetworkConfig& network,
                     const ObservationSpec& spec, const dnnl::memory& features)
    : trunk_(context, "actor", spec, 0, features, {}),
      mlp_(context, "actor.mlp", int(network.hidden.size()), trunk_.input()),
      batch_(context.batch),
      action_size_(spec.action_size),
      mean_(size_t(batch_) * size_t(action_size_)),
      log_std_(mean_.size()),
      output_gradient_(2 * mean_.size()) {}

void ActorHead::Refresh() {
  trunk_.Refresh();
  mlp_.Refresh();
}

void ActorHead::Forward(const float* vector) {
  trunk_.Forward(vector);
  trunk_.input().Commit();
  mlp_.Forward();
  for (int b = 0; b < batch_; ++b) {
    const float* output = mlp_.output() + int64_t(b) * 2 * action_size_;
    for (int j = 0; j < action_size_; ++j) {
      const size_t at = size_t(b) * size_t(action_size_) + size_t(j);
      mean_[at] = output[j];
      log_std_[at] = kLogStdLow + kLogStdHalfRange * (std::tanh(output[action_size_ + j]) + 1);
    }
  }
}

// dlog_std/dr = 3.5 (1 - tanh(r)^2), with tanh(r) = (log_std + 5) / 3.5 - 1.
void ActorHead::Backward(const float* mean_gradient, const float* log_std_gradient) {
  for (int b = 0; b < batch_; ++b) {
    float* gradient = output_gradient_.data() + int64_t(b) * 2 * action_size_;
    for (int j = 0; j < action_size_; ++j) {
      const size_t at = size_t(b) * size_t(action_size_) + size_t(j);
      const float t = (log_std_[at] - kLogStdLow) / kLogStdHalfRange - 1;
      gradient[j] = mean_gradient[at];
      gradient[action_size_ + j] = log_std_gradient[at] * kLogStdHalfRange * (1 - t * t);
    }
  }
  mlp_.Backward(output_gradient_.data(), {.parameters = true, .source = true});
  trunk_.Backward(mlp_.input_gradient());
}

}  // namespace shoal::nn
