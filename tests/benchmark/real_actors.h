// SPDX-License-Identifier: Apache-2.0
// Env steps a second of real actor processes that act from pixels and send to a real replay server.
#pragma once

#include <vector>

#include "tests/benchmark/many_actors.h"
#include "tests/benchmark/paired_timing.h"

namespace shoal::bench {

// FetchReach from one 84x84 camera, in quality `fast` and in `native`: one actor beside
// 1 / (step + render + infer + send, each alone), N actors on N cores beside N times one, and N
// threads that send nothing beside N times one of them; then N actors of quality `reference`. Of
// `options`: programs, seconds. Throws Error as MeasureManyActors does.
std::vector<Row> RealActorRows(const ManyActorsOptions& options, int repetitions);

}  // namespace shoal::bench
