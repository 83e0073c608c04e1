// SPDX-License-Identifier: Apache-2.0
// One process-wide request to stop, set by SIGINT / SIGTERM / SIGHUP (the terminal's or the
// parent's end). Polled by every loop; never un-set.
#pragma once

#include <atomic>

namespace shoal {

// Installs handlers for SIGINT and SIGTERM that call RequestStop, for SIGHUP (unless it is ignored,
// as under nohup), and ignores SIGPIPE. SIGHUP asks for a stop but is not counted, so that it
// never means haste: the kernel sends a parent's death once per thread that the parent had.
void InstallStopSignals();
// Async-signal-safe.
void RequestStop();
bool StopRequested();
// How many times a stop was asked for but by SIGHUP: a second Ctrl-C means "now".
int StopRequests();

// Exit code of a command that a signal stopped, as shells have it: a script that loops over
// commands ends with it, too.
inline constexpr int kInterruptedExit = 130;

}  // namespace shoal
