// SPDX-License-Identifier: Apache-2.0
// An actor computes a Gaussian over actions before tanh, or one action, from features and vector
// (Eq. 4 of docs/algorithm.md).
//
// Dimensions: B batch, A actions, V vector size.
#pragma once

#include <memory>

#include "common/nn/actor_critic_plan.h"
#include "common/nn/array.h"
#include "common/nn/module.h"
#include "common/nn/networks.h"

namespace shoal::nn {

class ActorModule final : public Module {
 public:
  // `features`: borrowed; null without pixels. trains_encoder: whether Backward writes the gradient
  // of the features for their encoder.
  ActorModule(const ActorPlan& plan, const Features* features, bool trains_encoder, Use use,
              const ModuleContext& context);

  using Output = ActorArrays;

  // The trunk's outputs, for a readout; null without pixels.
  const Features* trunk_features() const { return network_->trunk_features(); }

  void Refresh() override { network_->Refresh(); }
  // Reads the current features and vector (B, V).
  Output Forward(Array vector) { return network_->Forward(vector); }
  // Computes the gradients of the parameters for the latest Forward of a Gaussian actor. Arguments:
  // dL/dmean and dL/dlog_std, both (B, A).
  void Backward(Array mean_gradient, Array log_std_gradient) {
    network_->Backward(mean_gradient, log_std_gradient);
  }
  // Computes the gradients of the parameters for the latest Forward of a deterministic actor.
  // action_gradient: dL/daction (B, A). The loss also includes mean_penalty times the mean square
  // of `mean`.
  void BackwardAction(Array action_gradient, double mean_penalty) {
    network_->BackwardAction(action_gradient, mean_penalty);
  }

 private:
  const std::unique_ptr<ActorNetwork> network_;
};

}  // namespace shoal::nn
