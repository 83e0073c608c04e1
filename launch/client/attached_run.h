// SPDX-License-Identifier: Apache-2.0
// `shoal attach`: the progress of a running run, far from its coordinator.
#pragma once

#include <chrono>

#include "launch/client/run_client.h"
#include "launch/watch/progress.h"

namespace shoal::launch {

// Without a view for so long the run's coordinator is gone.
inline constexpr std::chrono::seconds kAttachedSilence{15};

// Shows progress and events until the run ends, and returns its exit code; 0 after a stop signal.
// Throws Error: the coordinator does not answer, or is silent.
int ShowAttached(RunClient& client, Progress& progress);

}  // namespace shoal::launch
