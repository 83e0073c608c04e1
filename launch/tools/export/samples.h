// SPDX-License-Identifier: Apache-2.0
// Observations and the actions that our own networks answer them with, for other runtimes to be
// held to.
#pragma once

#include <string>
#include <vector>

#include "common/policy/checkpoint_policy.h"
#include "launch/tools/export/observations.h"

namespace shoal::launch {

// The bytes of a safetensors file: `pixels` U8 (N, K*C, H, W) where there are pixels, each observed
// block F32 (N, size) by its name, and `action` F32 (N, A), of all sets one after another.
std::string WriteSamples(const policy::CheckpointPolicy& policy,
                         const std::vector<ObservationSet>& sets);

}  // namespace shoal::launch
