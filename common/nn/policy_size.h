// How large a policy is when it travels: refused by configuration, before anything is built.
#pragma once

#include <cstdint>

#include "common/config/config.h"
#include "common/spec/observation_spec.h"

namespace shoal::nn {

// Bytes of the policy's F32 parameters (encoder and actor) as safetensors, at most; a few hundred
// bytes per tensor above the exact size.
int64_t PolicyBytes(const NetworkConfig& network, const ObservationSpec& spec);

// Throws Error (kUsage) when they exceed `most_bytes`, naming the key that makes the largest
// tensor.
void CheckPolicySize(const NetworkConfig& network, const ObservationSpec& spec, int64_t most_bytes);

}  // namespace shoal::nn
