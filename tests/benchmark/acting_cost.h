// SPDX-License-Identifier: Apache-2.0
// The cost of inference in an actor, measured without the actor's other work, with an untrained
// policy.
#pragma once

#include <memory>
#include <string>

#include "actor/acting/action_selector.h"
#include "common/config/run_config.h"

namespace shoal::bench {

// Initial weights of a policy, as safetensors.
std::string FirstWeights(const RunConfig& run);

// A selector with these weights. An episode has begun in each environment.
std::unique_ptr<actor::ActionSelector> MakeSelector(const RunConfig& run,
                                                    const std::string& weights);

// Time per action of one environment if the actions of all environments of an actor are computed
// together; measured for `seconds`.
double InferSeconds(const RunConfig& run, const std::string& weights, double seconds);

// Like InferSeconds, but CPU time of the calling thread, which does not depend on other load of the
// machine.
double InferCpuSeconds(const RunConfig& run, const std::string& weights, double seconds);

}  // namespace shoal::bench
