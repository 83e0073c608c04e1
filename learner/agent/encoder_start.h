// SPDX-License-Identifier: Apache-2.0
// Starts an agent's encoder from given weights instead of random weights.
#pragma once

#include "common/nn/safetensors.h"
#include "learner/agent/agent.h"

namespace shoal::learner {

// Copies `weights`, the complete result of nn::ReadEncoderWeights, to the agent's encoder.NAME and
// to all copies PREFIX.encoder.NAME. Optimisers do not change. Call it before the first update.
// CHECKs that the agent has each tensor.
void StartEncoder(const nn::TensorMap& weights, Agent* agent);

}  // namespace shoal::learner
