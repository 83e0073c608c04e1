// SPDX-License-Identifier: Apache-2.0
// An agent whose networks start from given weights instead of random ones.
//
// The agent takes over networks (encoder.*, actor.*, critic.*, value.*, their targets and averages)
// and the running moments of observations. Optimisers, temperature, counters and the scale of
// rewards start as in any new run.
#pragma once

#include <string>

#include "common/nn/safetensors.h"
#include "learner/agent/agent.h"

namespace shoal::learner {

// The AllTensors of an agent that starts from `weights` (F32, Shoal's names): they replace the
// tensors of `agent` and those copies that `weights` lacks (averages, targets, further encoders).
// The policy must be complete; a critic is optional. Throws Error (usage) naming `source` and a
// tensor that is missing, of another shape or type, not finite or unknown to this network.
nn::TensorMap StartTensors(const nn::TensorMap& weights, const std::string& source,
                           const Agent& agent);

}  // namespace shoal::learner
