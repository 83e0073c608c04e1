// SPDX-License-Identifier: Apache-2.0
// Starts an agent's networks from given weights instead of random weights.
//
// Given weights replace networks (encoder.*, actor.*, critic.*, value.*, model.*, their targets and
// averages), the running moments of observations and the scales of critics. Optimisers,
// temperature, counters and the scale of rewards start as in every new run.
#pragma once

#include <string>

#include "common/nn/safetensors.h"
#include "learner/agent/agent.h"

namespace shoal::learner {

// Returns all tensors (Agent::AllTensors) of an agent that starts from `weights` (F32, Shoal's
// names). The tensors in `weights` replace tensors of `agent`. If `weights` has no averages,
// targets or further encoders, copies of the given tensors replace them. The policy must be
// complete; a critic is optional. Throws Error (kUsage) that names `source` and the tensor if a
// tensor is missing, has a wrong shape or type, is not finite or does not belong to this network.
nn::TensorMap StartTensors(const nn::TensorMap& weights, const std::string& source,
                           const Agent& agent);

}  // namespace shoal::learner
