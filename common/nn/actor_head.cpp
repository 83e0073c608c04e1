// SPDX-License-Identifier: Apache-2.0
#include "common/nn/actor_head.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"

namespace shoal::nn {
namespace {

constexpr float kLogStdLow = -5, kLogStdHalfRange = 3.5f;  // kSmooth
constexpr float kClampLow = -20, kClampHigh = 2;           // kClamped

}  // namespace

ActorHead::ActorHead(const LayerContext& context, const ActorPlan& plan,
                     const dnnl::memory& features, const dnnl::memory& features_gradient)
    : trunk_(context, plan, features, features_gradient),
      mlp_(context, plan.mlps.at(0), trunk_.input()),
      gaussian_(plan.output == ActorOutput::kGaussian),
      free_log_std_(plan.output == ActorOutput::kUnsquashed
                        ? context.parameters->Find(plan.name + ".log_std")
                        : Parameter()),
      log_std_kind_(plan.log_std),
      batch_(context.batch),
      action_size_(mlp_.outputs() / (gaussian_ ? 2 : 1)),
      mean_(size_t(batch_) * size_t(action_size_)),
      log_std_(plan.output == ActorOutput::kDeterministic ? 0 : mean_.size()),
      action_(plan.output == ActorOutput::kDeterministic ? mean_.size() : 0),
      output_gradient_(size_t(batch_) * size_t(mlp_.outputs())) {}

void ActorHead::Refresh() {
  trunk_.Refresh();
  mlp_.Refresh();
  if (gaussian_ || log_std_.empty()) return;
  for (size_t i = 0; i < log_std_.size(); ++i) {
    log_std_[i] = free_log_std_.value()[i % size_t(action_size_)];
  }
}

void ActorHead::Forward(const float* vector) {
  trunk_.Forward(vector);
  mlp_.Forward();
  for (int b = 0; b < batch_; ++b) {
    const float* output = mlp_.output() + int64_t{b} * mlp_.outputs();
    std::copy_n(output, action_size_, mean_.data() + int64_t{b} * action_size_);
  }
  if (gaussian_) ForwardLogStd();
  for (size_t i = 0; i < action_.size(); ++i) action_[i] = std::tanh(mean_[i]);
}

void ActorHead::ForwardLogStd() {
  for (int b = 0; b < batch_; ++b) {
    const float* raw = mlp_.output() + int64_t{b} * mlp_.outputs() + action_size_;
    float* log_std = log_std_.data() + int64_t{b} * action_size_;
    for (int j = 0; j < action_size_; ++j) {
      log_std[j] = log_std_kind_ == LogStd::kClamped
                       ? std::clamp(raw[j], kClampLow, kClampHigh)
                       : kLogStdLow + kLogStdHalfRange * (std::tanh(raw[j]) + 1);
    }
  }
}

// Smooth: dlog_std/dr = 3.5 (1 - tanh(r)^2), with tanh(r) = (log_std + 5) / 3.5 - 1.
// Clamped: 1 within the range, 0 beyond.
void ActorHead::Backward(const float* mean_gradient, const float* log_std_gradient) {
  CHECK(gaussian_);
  for (int b = 0; b < batch_; ++b) {
    const float* raw = mlp_.output() + int64_t{b} * mlp_.outputs() + action_size_;
    float* gradient = output_gradient_.data() + int64_t{b} * mlp_.outputs();
    for (int j = 0; j < action_size_; ++j) {
      const size_t at = size_t(b) * size_t(action_size_) + size_t(j);
      gradient[j] = mean_gradient[at];
      if (log_std_kind_ == LogStd::kClamped) {
        const bool inside = raw[j] >= kClampLow && raw[j] <= kClampHigh;
        gradient[action_size_ + j] = inside ? log_std_gradient[at] : 0.f;
      } else {
        const float t = (log_std_[at] - kLogStdLow) / kLogStdHalfRange - 1;
        gradient[action_size_ + j] = log_std_gradient[at] * kLogStdHalfRange * (1 - t * t);
      }
    }
  }
  BackwardMlp();
}

// daction/dmean = 1 - action^2.
void ActorHead::BackwardAction(const float* action_gradient, double mean_penalty) {
  CHECK(!action_.empty());
  const auto slope = float(2 * mean_penalty / double(action_.size()));
  for (size_t i = 0; i < action_.size(); ++i) {
    output_gradient_[i] = action_gradient[i] * (1 - action_[i] * action_[i]);
    if (slope > 0) output_gradient_[i] += slope * mean_[i];
  }
  BackwardMlp();
}

void ActorHead::BackwardMlp() {
  mlp_.Backward(output_gradient_.data(),
                {.parameters = true, .source = trunk_.NeedsInputGradient()});
  trunk_.Backward(mlp_.input_gradient());
}

}  // namespace shoal::nn
