// SPDX-License-Identifier: Apache-2.0
// Parts of which the plans of actors, critics and latent models consist: trunks and MLPs. Names of
// parameters: actor_critic_plan.h.
#pragma once

#include <string>

#include "common/config/config.h"
#include "common/nn/network_plan.h"
#include "common/spec/observation_spec.h"

namespace shoal::nn {

// The trunk `head`.trunk above the encoder; without layers if the observation has no pixels.
NetworkPlan PlanTrunk(const NetworkConfig& network, const ObservationSpec& spec,
                      const std::string& head);

// Appends the layers `name`.layer0, ... of network.state_hidden: linear, LayerNorm, ELU.
void AddStateLayers(const NetworkConfig& network, const std::string& name, NetworkPlan* plan);

struct MlpLayers {
  std::string name;                         // prefix of their names
  int first = 0;                            // number of the first hidden layer
  double hidden_gain = 1, output_gain = 1;  // of orthogonal weights
};
// Appends the hidden layers of network.hidden and network.blocks, and a linear layer with `outputs`
// outputs.
void AddMlp(const NetworkConfig& network, const MlpLayers& layers, int outputs, NetworkPlan* plan);

}  // namespace shoal::nn
