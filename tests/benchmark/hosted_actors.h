// SPDX-License-Identifier: Apache-2.0
// The cost that Shoal adds to an env step of Python, in microseconds of one core.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/benchmark/many_actors.h"

namespace shoal::bench {

// One actor of trivial_environment.py, from state and from one 84x84 picture: CPU time of its
// process for each transition, less the environment's own step and acting, each measured alone.
// `python` has the package shoal_rl and gymnasium. Of `options`: programs, seconds. Rows of schema
// shoal-bench-1. Throws Error as MeasureManyActors does.
std::vector<nlohmann::ordered_json> HostedActorRows(const ManyActorsOptions& options,
                                                    const std::string& python, int repetitions);

}  // namespace shoal::bench
