// SPDX-License-Identifier: Apache-2.0
// Checks the memory and the message sizes that a configuration's networks need. A configuration
// that needs too much is refused by name before anything is built or started.
#pragma once

#include <cstdint>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"

namespace shoal::nn {

// Bytes of the policy's F32 parameters (encoder and actor) as safetensors, at most; a few hundred
// bytes per tensor above the exact size.
int64_t PolicyBytes(const NetworkConfig& network, const ObservationSpec& spec);

// Throws Error (kUsage) naming the key at fault where
//   - the encoder does not exist, does not fit the images or has keys of another beside it,
//   - batch statistics would be of a single value,
//   - an array of one layer for a batch has more numbers than 32 bits count,
//   - the policy's parameters exceed `most_bytes`.
void CheckNetwork(const NetworkConfig& network, const ObservationSpec& spec, int batch,
                  int64_t most_bytes);

}  // namespace shoal::nn
