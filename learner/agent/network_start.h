// SPDX-License-Identifier: Apache-2.0
// An agent whose networks start from given weights instead of random ones.
//
// Taken over are networks (encoder.*, actor.*, critic.*, value.*, their targets and averages) and
// the running moments of observations. Optimisers, temperature, counters and the scale of rewards
// start as always: what is learned is another run.
#pragma once

#include <string>

#include "common/nn/safetensors.h"
#include "learner/agent/agent.h"

namespace shoal::learner {

// What AllTensors gives of such an agent: `weights`, F32 by our names, in place of `agent`'s, and
// in place of the copies that `weights` does not have itself: averages, targets, encoders of their
// own. The policy must be there whole; a critic need not. Throws Error (usage) naming `source` and
// a tensor that is missing, of another shape or type, not finite or none of this network's.
nn::TensorMap StartTensors(const nn::TensorMap& weights, const std::string& source,
                           const Agent& agent);

}  // namespace shoal::learner
