// SPDX-License-Identifier: Apache-2.0
// Floating-point operations of one update, counted from the plans of its networks.
#pragma once

#include <cstdint>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"

namespace shoal::learner {

struct UpdateCost {
  int64_t encoder_parameters = 0;  // 0 without pixels
  // Floating-point operations of the matrix products, 2 a multiply-add; a backward pass is twice a
  // forward pass, less the gradients that are never computed: of the pixels and, in a step of the
  // actor, of features that it does not train. Activations, norms and optimisers are left out.
  //
  // Off policy, on average over updates with and without a step of the actor: encoder on
  // observations and next observations, critics on both (targets on the next), actor likewise, and
  // once back through the critics. On policy, of a whole rollout of all actors: values once, policy
  // and values forward and backward in each epoch.
  double flop = 0;
};

// Throws Error where the networks do not fit.
UpdateCost CostOfUpdate(const Config& config, const ObservationSpec& spec);

}  // namespace shoal::learner
