// SPDX-License-Identifier: Apache-2.0
// The layers of the critic above the encoder: one trunk, and one or more Q functions.
//
//   q_i(s, a) = MLP_i([ trunk(features) | vector | a ]),  i = 1, 2, ...
//
// Dimensions: B batch, F trunk outputs, V vector size, A actions.
#pragma once

#include <span>
#include <vector>

#include "common/nn/array.h"
#include "common/nn/mlp.h"
#include "common/nn/observation_trunk.h"

namespace shoal::nn {

class CriticHeads {
 public:
  // features_gradient: gradient memory of the encoder; empty if this critic does not train the
  // encoder.
  CriticHeads(const LayerContext& context, const HeadPlan& plan, const dnnl::memory& features,
              const dnnl::memory& features_gradient);

  int count() const { return int(mlps_.size()); }
  // (B), or (B, outputs) if the plan has several outputs.
  const float* q(int i) const { return mlps_[size_t(i)].output(); }

  // See ObservationTrunk::features.
  const HostFeatures* trunk_features() const { return trunk_.features(); }

  void Refresh();
  // Computes the part that depends on the observation alone. vector: (B, V).
  void ForwardObservation(const float* vector);
  // Computes the Q functions of the latest observation and of action (B, A). Several calls, with
  // different actions, may follow one ForwardObservation.
  void ForwardAction(const float* action);

  // dL/dq_i, of the shape of q(i), one for each Q function; an empty array counts as zeros.
  using QGradients = std::span<const Array>;
  // Computes the gradients of all parameters and of the features.
  void Backward(QGradients q_gradients);
  // Computes only the gradient of the action (B, A).
  void BackwardAction(QGradients q_gradients, float* action_gradient);

 private:
  // Sums dL/dinput over the Q functions into input_gradient_ if wanted.source is set.
  void BackwardMlps(QGradients q_gradients, Gradients wanted);
  void SumInputGradient(const float* gradient, bool first);

  ObservationTrunk trunk_;
  std::vector<Mlp> mlps_;
  int action_size_;
  std::vector<float> zeros_;           // (B), or (B, outputs)
  std::vector<float> input_gradient_;  // (B, F + V + A)
};

}  // namespace shoal::nn
