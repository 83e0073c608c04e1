// SPDX-License-Identifier: Apache-2.0
// The layers between an encoder and a latent state (latent_plan.h).
//
// Dimensions: B batch, V vector size, Z numbers of the state.
#pragma once

#include <memory>

#include "common/nn/array.h"
#include "common/nn/latent_plan.h"
#include "common/nn/module.h"
#include "common/nn/networks.h"

namespace shoal::nn {

// Computes on the CPU only.
class LatentStateModule final : public Module {
 public:
  // `features`: borrowed; null without pixels. trains_encoder: whether Backward writes the gradient
  // of the features for their encoder.
  LatentStateModule(const StatePlan& plan, const Features* features, bool trains_encoder, Use use,
                    const ModuleContext& context);
  ~LatentStateModule() override;

  void Refresh() override;
  // Returns the state (B, Z) of the current features and of `vector` (B, V).
  Array Forward(Array vector);
  // Computes the gradients of the parameters, and of the features, from dL/dz (B, Z).
  void Backward(Array gradient);

 private:
  struct Network;
  const std::unique_ptr<Network> network_;
};

}  // namespace shoal::nn
