// SPDX-License-Identifier: Apache-2.0
// Env steps per second of real actor processes that act from pixels and send to a real replay
// server.
#pragma once

#include <vector>

#include "tests/benchmark/many_actors.h"
#include "tests/benchmark/paired_timing.h"

namespace shoal::bench {

// Measures FetchReach from one 84x84 camera. In the qualities `fast` and `native` the function
// compares
// - one actor with 1 / (step + render + infer + send), where each time is measured alone,
// - N actors on N cores with N times one actor,
// - N threads that send no records with N times one such thread.
// Then the function measures N actors of quality `reference`. Uses `programs` and `seconds` of
// `options`. Throws the errors of MeasureManyActors.
std::vector<Row> RealActorRows(const ManyActorsOptions& options, int repetitions);

}  // namespace shoal::bench
