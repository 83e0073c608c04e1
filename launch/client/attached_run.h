// SPDX-License-Identifier: Apache-2.0
// `shoal attach`: shows the progress of a run in another process than the run's coordinator.
#pragma once

#include <chrono>

#include "launch/client/run_client.h"
#include "launch/watch/progress.h"

namespace shoal::launch {

// If no view arrives for this time, the coordinator is treated as dead.
inline constexpr std::chrono::seconds kAttachedSilence{15};

// Shows progress and events until the run ends, and returns the run's exit code; 0 after a stop
// signal. Throws Error if the coordinator does not answer, or is silent for kAttachedSilence.
int ShowAttached(RunClient& client, Progress& progress);

}  // namespace shoal::launch
