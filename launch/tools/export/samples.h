// SPDX-License-Identifier: Apache-2.0
// Observations with the actions of Shoal's own networks, as a reference for other runtimes.
#pragma once

#include <string>
#include <vector>

#include "common/policy/checkpoint_policy.h"
#include "launch/tools/export/observations.h"

namespace shoal::launch {

// The bytes of a safetensors file with the tensors `pixels` U8 (N, K*C, H, W) if there are pixels,
// each observed block F32 (N, size) by its name, and `action` F32 (N, A). The samples of all sets
// follow one another.
std::string WriteSamples(const policy::CheckpointPolicy& policy,
                         const std::vector<ObservationSet>& sets);

}  // namespace shoal::launch
