// The critic above the encoder: one trunk, two Q functions.
//
//   q_i(s, a) = MLP_i([ trunk(features) | vector | a ]),  i = 1, 2
//
// Dimensions: B batch, A actions, V vector size.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/nn/mlp.h"
#include "common/nn/observation_trunk.h"

namespace shoal::nn {

class CriticHeads {
 public:
  // Parameters `head`.* with head "critic" or "target". features_gradient: the encoder's, or empty.
  CriticHeads(const LayerContext& context, const std::string& head, const NetworkConfig& network,
              const ObservationSpec& spec, const dnnl::memory& features,
              const dnnl::memory& features_gradient);

  const float* q(int i) const { return mlps_[size_t(i)].output(); }  // (B), i in {0, 1}

  void Refresh();
  // The observation's part; vector (B, V).
  void ForwardObservation(const float* vector);
  // The rest, for the latest observation; action (B, A). May be called again with other actions.
  void ForwardAction(const float* action);
  // From dL/dq_i (B): gradients of all parameters and of the features.
  void Backward(const float* q0_gradient, const float* q1_gradient);
  // From dL/dq_i (B): the gradient of the action (B, A) alone.
  void BackwardAction(const float* q0_gradient, const float* q1_gradient, float* action_gradient);

 private:
  ObservationTrunk trunk_;
  std::array<Mlp, 2> mlps_;
  int action_size_;
  std::vector<float> input_gradient_;  // (B, F + V + A), sum over the two
};

}  // namespace shoal::nn
