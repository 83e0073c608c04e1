// SPDX-License-Identifier: Apache-2.0
// Checks the memory and the message sizes that a configuration's networks need. These checks run
// before any network is built and before any process is started.
#pragma once

#include <cstdint>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"

namespace shoal::nn {

// Upper bound for the bytes of the policy's F32 parameters (encoder and actor) as safetensors. The
// bound exceeds the exact size by a few hundred bytes per tensor.
int64_t PolicyBytes(const NetworkConfig& network, const ObservationSpec& spec);

// Throws Error (kUsage) that names the key at fault if
//   - the encoder does not exist, does not fit the images, or keys of another encoder are set,
//   - batch statistics would be computed from a single value,
//   - an array of one layer for a batch has more numbers than a 32-bit integer can count,
//   - the policy's parameters exceed `most_bytes`.
void CheckNetwork(const NetworkConfig& network, const ObservationSpec& spec, int batch,
                  int64_t most_bytes);

}  // namespace shoal::nn
