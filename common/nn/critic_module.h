// SPDX-License-Identifier: Apache-2.0
// A critic: one trunk and one or more Q functions of features, vector and action.
#pragma once

#include <memory>
#include <span>

#include "common/nn/actor_critic_plan.h"
#include "common/nn/array.h"
#include "common/nn/module.h"

namespace shoal::nn {

class Features;

class CriticModule final : public Module {
 public:
  // `plan` of PlanCritic. `features`: borrowed; null without pixels. trains_encoder: Backward
  // leaves the gradient of the features to their encoder.
  CriticModule(const HeadPlan& plan, const Features* features, bool trains_encoder, Use use,
               const ModuleContext& context);
  ~CriticModule() override;

  // Q functions.
  int count() const;
  // (B) of the latest ForwardAction; of a plan with several outputs (B, outputs).
  Array q(int i) const;

  // The trunk's outputs, for a readout; null without pixels.
  const Features* trunk_features() const;

  void Refresh() override;
  // The observation's part, for the features as they are; vector (B, V).
  void ForwardObservation(Array vector);
  // The rest, for the latest observation; action (B, A), none where the plan has none. May be
  // called again with other actions.
  void ForwardAction(Array action);

  // dL/dq_i, as q(i), one for each Q function; none: it is no part of the loss.
  using Gradients = std::span<const Array>;
  // Gradients of all parameters; those of a function that is no part of the loss become 0.
  void Backward(Gradients q_gradients);
  // The gradient of the action (B, A) alone.
  void BackwardAction(Gradients q_gradients, Array action_gradient);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shoal::nn
