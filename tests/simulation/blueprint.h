// SPDX-License-Identifier: Apache-2.0
// Configuration and initial weights of a simulated run.
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "common/config/run_config.h"
#include "common/nn/safetensors.h"

namespace shoal::simulation {

// Simulated durations of a step and of an update.
inline constexpr std::chrono::microseconds kStep{20'000}, kUpdate{30'000};

struct Blueprint {
  RunConfig run;
  nn::TensorMap policy;
};

// Three blueprints: off policy with the ring in a file, off policy with the ring in memory, and on
// policy. The function is slow, because it creates the real task and a real agent; call it once.
std::vector<Blueprint> MakeBlueprints();

// Selects the blueprint of a seed.
const Blueprint& BlueprintOf(uint64_t seed, const std::vector<Blueprint>& blueprints);

}  // namespace shoal::simulation
