// SPDX-License-Identifier: Apache-2.0
// Acting by a policy as it starts, alone: what an actor spends on it.
#pragma once

#include <memory>
#include <string>

#include "actor/acting/action_selector.h"
#include "common/config/run_config.h"

namespace shoal::bench {

// A policy as it starts, as safetensors.
std::string FirstWeights(const RunConfig& run);

// A selector that has these weights and has begun an episode of each environment.
std::unique_ptr<actor::ActionSelector> MakeSelector(const RunConfig& run,
                                                    const std::string& weights);

// An action of one environment, of all that an actor has at once; measured for `seconds`.
double InferSeconds(const RunConfig& run, const std::string& weights, double seconds);

// The same in CPU time of the calling thread, which other work on the machine does not prolong.
double InferCpuSeconds(const RunConfig& run, const std::string& weights, double seconds);

}  // namespace shoal::bench
