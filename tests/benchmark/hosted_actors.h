// SPDX-License-Identifier: Apache-2.0
// The cost that Shoal adds to an env step of a Python environment, in microseconds of one core.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/benchmark/many_actors.h"

namespace shoal::bench {

// Measures one actor with trivial_environment.py, from state and from one 84x84 picture. The cost
// is the CPU time of the actor's process per transition, minus the environment's own step and the
// inference, which are measured separately. `python` must have the packages shoal_rl and gymnasium.
// Uses `programs` and `seconds` of `options`. Returns rows of schema shoal-bench-1. Throws the
// errors of MeasureManyActors.
std::vector<nlohmann::ordered_json> HostedActorRows(const ManyActorsOptions& options,
                                                    const std::string& python, int repetitions);

}  // namespace shoal::bench
