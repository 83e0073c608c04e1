// SPDX-License-Identifier: Apache-2.0
// The end of a run after its processes have exited: the account of its records, a final evaluation
// on fresh episodes, meta.json and the summary.
#pragma once

#include <filesystem>

#include "common/link/run_topology.h"
#include "launch/run/coordinator.h"
#include "launch/watch/progress.h"

namespace shoal::launch {

// Evaluates the run unless it was interrupted, and makes a film if `film` is true. Removes the ring
// of a finished run, unless replay.keep is set. Prints the summary and returns the run's exit code:
// 1 if the run failed, a process exited with an error, the records do not balance, or a requested
// film is missing; otherwise kUnwrittenExit if a result could not be written, else 0.
int EndRun(const std::filesystem::path& run, const Config& config,
           const link::RunTopology& topology, RunResult result, bool film, RunServer& server,
           Progress& progress);

}  // namespace shoal::launch
