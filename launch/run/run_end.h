// SPDX-License-Identifier: Apache-2.0
// The end of a run, once its processes have left: the account of its records, a last evaluation on
// fresh episodes, meta.json and the summary.
#pragma once

#include <filesystem>

#include "common/link/run_topology.h"
#include "launch/run/coordinator.h"
#include "launch/watch/progress.h"

namespace shoal::launch {

// Evaluates the run unless it was interrupted; `film` asks for a film of it as well. Removes the
// ring of a finished run, unless replay.keep. Prints the summary and returns the run's exit code: 1
// when it failed, a process left with an error, the records do not balance, or there is no film
// that was asked for; else kUnwrittenExit when something of it could not be written.
int EndRun(const std::filesystem::path& run, const Config& config,
           const link::RunTopology& topology, RunResult result, bool film, RunServer& server,
           Progress& progress);

}  // namespace shoal::launch
