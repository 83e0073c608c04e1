// The policy above the encoder: trunk and MLP to a Gaussian over actions before tanh (Eq. 4 of
// docs/algorithm.md).
//
//   (mean, r) = MLP(trunk(features), vector)
//   log_std = -5 + 3.5 (tanh(r) + 1)      in [-5, 2]
//
// Dimensions: B batch, A actions, V vector size.
#pragma once

#include <vector>

#include "common/nn/mlp.h"
#include "common/nn/observation_trunk.h"

namespace shoal::nn {

class ActorHead {
 public:
  // Parameters actor.*. The features get no gradient: the encoder is the critic's.
  ActorHead(const LayerContext& context, const NetworkConfig& network, const ObservationSpec& spec,
            const dnnl::memory& features);

  const float* mean() const { return mean_.data(); }        // (B, A)
  const float* log_std() const { return log_std_.data(); }  // (B, A)

  void Refresh();
  // vector (B, V).
  void Forward(const float* vector);
  // dL/dmean, dL/dlog_std (B, A).
  void Backward(const float* mean_gradient, const float* log_std_gradient);

 private:
  ObservationTrunk trunk_;
  Mlp mlp_;
  int batch_, action_size_;
  std::vector<float> mean_, log_std_;   // (B, A)
  std::vector<float> output_gradient_;  // (B, 2A)
};

}  // namespace shoal::nn
