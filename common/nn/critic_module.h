// SPDX-License-Identifier: Apache-2.0
// A critic: one trunk and one or more Q functions of features, vector and action.
//
// Dimensions: B batch, V vector size, A actions.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "common/nn/actor_critic_plan.h"
#include "common/nn/array.h"
#include "common/nn/module.h"
#include "common/nn/networks.h"

namespace shoal::nn {

class CriticModule final : public Module {
 public:
  // `plan`: from PlanCritic. `features`: borrowed; null without pixels. trains_encoder: whether
  // Backward writes the gradient of the features for their encoder.
  CriticModule(const HeadPlan& plan, const Features* features, bool trains_encoder, Use use,
               const ModuleContext& context);

  // Number of Q functions.
  int count() const { return network_->count(); }
  // Result (B) of the latest ForwardAction; (B, outputs) if the plan has several outputs.
  Array q(int i) const { return network_->q(i); }
  // Results of all Q functions.
  std::vector<Array> values() const;

  // The trunk's outputs, for a readout; null without pixels.
  const Features* trunk_features() const { return network_->trunk_features(); }

  void Refresh() override { network_->Refresh(); }
  // Computes the part that depends on the observation alone, from the current features and vector
  // (B, V).
  void ForwardObservation(Array vector) { network_->ForwardObservation(vector); }
  // Computes the Q functions of the latest observation and of action (B, A). The action is empty if
  // the plan has no action. Several calls, with different actions, may follow one
  // ForwardObservation.
  void ForwardAction(Array action) { network_->ForwardAction(action); }

  // dL/dq_i, of the shape of q(i), one for each Q function; empty if the loss does not use this Q
  // function.
  using Gradients = std::span<const Array>;
  // Computes the gradients of all parameters. If the loss does not use a Q function, the gradients
  // of its parameters become 0.
  void Backward(Gradients q_gradients) { network_->Backward(q_gradients); }
  // Computes only the gradient of the action (B, A).
  void BackwardAction(Gradients q_gradients, Array action_gradient) {
    network_->BackwardAction(q_gradients, action_gradient);
  }

 private:
  const std::unique_ptr<CriticNetwork> network_;
};

}  // namespace shoal::nn
