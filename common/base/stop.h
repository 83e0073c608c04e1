// One process-wide request to stop, set by SIGINT / SIGTERM, a failed thread or the death of the
// parent. Polled by every loop; never un-set.
#pragma once

#include <atomic>

namespace shoal {

// Installs handlers for SIGINT and SIGTERM that call RequestStop, and ignores SIGPIPE.
void InstallStopSignals();
// Async-signal-safe.
void RequestStop();
bool StopRequested();
// How many times a stop was asked for: a second Ctrl-C means "now".
int StopRequests();

}  // namespace shoal
