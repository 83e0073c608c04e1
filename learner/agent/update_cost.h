// SPDX-License-Identifier: Apache-2.0
// Floating-point operations of one update, counted from the plans of its networks.
#pragma once

#include <cstdint>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"

namespace shoal::learner {

struct UpdateCost {
  int64_t encoder_parameters = 0;  // 0 without pixels
  // Floating-point operations of the matrix products; a multiply-add counts as 2. A backward pass
  // costs twice as much as a forward pass, minus the gradients that are never computed. These are
  // the gradients of pixels and, in a step of the actor, the gradients of features that the actor
  // does not train. Activations, norms and optimisers are not counted.
  //
  // Off policy, the number is an average over updates with and without a step of the actor. It
  // includes the encoder and the actor on observations and next observations, the critics on
  // observations, the targets on next observations, and one backward pass through the critics for
  // the action's gradient. On policy, the number is for the rollouts of all actors: one forward
  // pass of the values, then in each epoch a forward and a backward pass of policy and values.
  double flop = 0;
};

// Throws Error if the networks do not fit the configuration.
UpdateCost CostOfUpdate(const Config& config, const ObservationSpec& spec);

}  // namespace shoal::learner
