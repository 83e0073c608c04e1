// SPDX-License-Identifier: Apache-2.0
// Configuration and weights that a simulated run begins with.
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "common/config/run_config.h"
#include "common/nn/safetensors.h"

namespace shoal::simulation {

inline constexpr std::chrono::microseconds kStep{20'000}, kUpdate{30'000};  // simulated

struct Blueprint {
  RunConfig run;
  nn::TensorMap policy;
};

// Off policy with the ring in a file and with the ring in memory, and on policy. Making one asks
// the real task and a real agent: once is enough.
std::vector<Blueprint> MakeBlueprints();

// The one that a seed runs.
const Blueprint& BlueprintOf(uint64_t seed, const std::vector<Blueprint>& blueprints);

}  // namespace shoal::simulation
