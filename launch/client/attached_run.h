// SPDX-License-Identifier: Apache-2.0
// `shoal attach`: the progress of a running run, in another process than its coordinator.
#pragma once

#include <chrono>

#include "launch/client/run_client.h"
#include "launch/watch/progress.h"

namespace shoal::launch {

// If no view arrives for so long, the coordinator counts as dead.
inline constexpr std::chrono::seconds kAttachedSilence{15};

// Shows progress and events until the run ends, and returns its exit code; 0 after a stop signal.
// Throws Error: the coordinator does not answer, or is silent.
int ShowAttached(RunClient& client, Progress& progress);

}  // namespace shoal::launch
