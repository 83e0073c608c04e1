// SPDX-License-Identifier: Apache-2.0
// Text of a policy's network: one line per layer, with everything that determines its result except
// the parameters. Equal lines mean equal networks; the text leaves out how parameters start. It is
// stored beside a policy's parameters, so that a program whose network of the same name computes
// something else detects this before it acts.
#pragma once

#include <string>
#include <vector>

#include "common/nn/actor_critic_plan.h"
#include "common/nn/network_plan.h"

namespace shoal::nn {

// "encoder.conv0: convolution of layer 0, 9x42x42 to 32x20x20, kernel 3, stride 2, padding 0, bias,
// relu"
std::string PlanLine(const LayerPlan& layer);

// Lines of the encoder's layers, the trunk, the MLP and the use of the MLP's outputs.
std::vector<std::string> PlanLines(const NetworkPlan& encoder, const ActorPlan& actor);

// "gaussian", "deterministic", "unsquashed"
const char* ToString(ActorOutput output);

}  // namespace shoal::nn
