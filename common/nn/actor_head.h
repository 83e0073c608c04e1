// SPDX-License-Identifier: Apache-2.0
// The layers of the policy above the encoder. A trunk and an MLP compute a Gaussian over actions
// before tanh, or the action itself (Eq. 4 of docs/algorithm.md).
//
//   Gaussian        (mean, r) = MLP(trunk(features), vector)
//                   log_std = -5 + 3.5 (tanh(r) + 1), in [-5, 2]     LogStd::kSmooth
//                   log_std = r clamped to [-20, 2]                  LogStd::kClamped
//   unsquashed      mean = MLP(trunk(features), vector),   log_std is a parameter
//   deterministic   mean = MLP(trunk(features), vector),   action = tanh(mean)
//
// Dimensions: B batch, A actions, V vector size.
#pragma once

#include <vector>

#include "common/nn/mlp.h"
#include "common/nn/observation_trunk.h"

namespace shoal::nn {

class ActorHead {
 public:
  // features_gradient: gradient memory of the encoder; empty if this head does not train the
  // encoder.
  ActorHead(const LayerContext& context, const ActorPlan& plan, const dnnl::memory& features,
            const dnnl::memory& features_gradient);

  int batch() const { return batch_; }                // B
  int action_size() const { return action_size_; }    // A
  const float* mean() const { return mean_.data(); }  // (B, A), before tanh
  // Action (B, A); null for a Gaussian policy.
  const float* action() const { return action_.empty() ? nullptr : action_.data(); }
  // Log deviation (B, A); null for a deterministic policy.
  const float* log_std() const { return log_std_.empty() ? nullptr : log_std_.data(); }

  // See ObservationTrunk::features.
  const HostFeatures* trunk_features() const { return trunk_.features(); }

  void Refresh();
  // vector (B, V).
  void Forward(const float* vector);
  // Backward pass of a Gaussian policy. Arguments: dL/dmean and dL/dlog_std, both (B, A).
  void Backward(const float* mean_gradient, const float* log_std_gradient);
  // Backward pass of a deterministic policy: see ActorModule::BackwardAction.
  void BackwardAction(const float* action_gradient, double mean_penalty);

 private:
  void ForwardLogStd();
  // Reads output_gradient_.
  void BackwardMlp();

  ObservationTrunk trunk_;
  Mlp mlp_;
  const bool gaussian_;           // mean and log deviation are outputs of the MLP
  const Parameter free_log_std_;  // unsquashed policy only
  const LogStd log_std_kind_;
  int batch_, action_size_;
  std::vector<float> mean_;             // (B, A)
  std::vector<float> log_std_;          // (B, A); empty for a deterministic policy
  std::vector<float> action_;           // (B, A); empty for a Gaussian policy
  std::vector<float> output_gradient_;  // (B, 2A) if gaussian_, else (B, A)
};

}  // namespace shoal::nn
