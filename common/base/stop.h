// SPDX-License-Identifier: Apache-2.0
// One process-wide request to stop, set by SIGINT / SIGTERM / SIGHUP (the terminal's or the
// parent's end). Polled by every loop; never un-set. A thread of a group (thread_group.h) polls its
// group's request instead: signals are for the threads of no group.
#pragma once

#include <atomic>

namespace shoal {

// Installs handlers for SIGINT and SIGTERM that call RequestStop, for SIGHUP (unless it is ignored,
// as under nohup), and ignores SIGPIPE. SIGHUP requests a stop but is not counted, so that it
// never shortens the stop: the kernel sends it once per thread of a parent that died.
void InstallStopSignals();
// Async-signal-safe.
void RequestStop();
bool StopRequested();
// Number of stop requests except by SIGHUP: a second Ctrl-C means "now".
int StopRequests();
// The first stop signal that arrived; 0 without one, also after RequestStop.
int StopSignal();

// Value of a main's body that a stop request ended in order. GuardMain (main_guard.h) then ends the
// process by the signal; 130, which is what a shell reports for SIGINT, is the exit code where the
// request was no signal.
inline constexpr int kInterruptedExit = 130;

}  // namespace shoal
