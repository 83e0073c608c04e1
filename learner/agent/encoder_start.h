// SPDX-License-Identifier: Apache-2.0
// An agent whose encoder starts from given weights instead of random ones.
#pragma once

#include "common/nn/safetensors.h"
#include "learner/agent/agent.h"

namespace shoal::learner {

// `weights`: encoder.NAME, all of them, as nn::ReadEncoderWeights gives them. They become the
// agent's encoder.NAME and whatever copies of it there are, PREFIX.encoder.NAME; optimisers stay at
// their beginning. CHECKs that the agent has each. Before the first update.
void StartEncoder(const nn::TensorMap& weights, Agent* agent);

}  // namespace shoal::learner
