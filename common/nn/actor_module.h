// SPDX-License-Identifier: Apache-2.0
// An actor: features and vector to a Gaussian over actions before tanh, or to one action (Eq. 4 of
// docs/algorithm.md).
#pragma once

#include <memory>

#include "common/nn/actor_critic_plan.h"
#include "common/nn/array.h"
#include "common/nn/module.h"

namespace shoal::nn {

class Features;

class ActorModule final : public Module {
 public:
  // `features`: borrowed; null without pixels. trains_encoder: Backward leaves the gradient of the
  // features to their encoder.
  ActorModule(const ActorPlan& plan, const Features* features, bool trains_encoder, Use use,
              const ModuleContext& context);
  ~ActorModule() override;

  // All (B, A). mean: before tanh. log_std: none of a deterministic actor. action: tanh(mean) of a
  // deterministic actor, none of a Gaussian.
  struct Output {
    Array mean, log_std, action;
  };

  // The trunk's outputs, for a readout; null without pixels.
  const Features* trunk_features() const;

  void Refresh() override;
  // vector (B, V), for the features as they are.
  Output Forward(Array vector);
  // Gradients of the parameters, for the latest Forward of a Gaussian actor, from dL/dmean and
  // dL/dlog_std (B, A).
  void Backward(Array mean_gradient, Array log_std_gradient);
  // The same of a deterministic actor, from dL/daction (B, A). The loss besides has the term
  // mean_penalty times the mean of the squares of `mean`; 0 leaves it out.
  void BackwardAction(Array action_gradient, double mean_penalty);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace shoal::nn
