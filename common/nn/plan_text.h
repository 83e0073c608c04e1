// SPDX-License-Identifier: Apache-2.0
// Text of a policy's network: one line for each layer. A line contains everything that determines
// the layer's result, except the parameters. Initial values of parameters are left out. Equal texts
// mean equal networks. The text is stored together with a policy's parameters. Before a program
// acts, it compares the text with its own network, and so detects a network that has the same name
// but computes something else.
#pragma once

#include <string>
#include <vector>

#include "common/nn/actor_critic_plan.h"
#include "common/nn/network_plan.h"

namespace shoal::nn {

// Example: "encoder.conv0: convolution of layer 0, 9x42x42 to 32x20x20, kernel 3, stride 2, padding
// 0, bias, relu"
std::string PlanLine(const LayerPlan& layer);

// Lines of the encoder's layers, the trunk, the MLP and the use of the MLP's outputs.
std::vector<std::string> PlanLines(const NetworkPlan& encoder, const ActorPlan& actor);

// "gaussian", "deterministic", "unsquashed"
const char* ToString(ActorOutput output);

}  // namespace shoal::nn
