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

// Three blueprints: off policy with the ring in a file, off policy with the ring in memory, and on
// policy. Slow, because it creates the real task and a real agent; call it once.
std::vector<Blueprint> MakeBlueprints();

// The blueprint of a seed.
const Blueprint& BlueprintOf(uint64_t seed, const std::vector<Blueprint>& blueprints);

}  // namespace shoal::simulation
