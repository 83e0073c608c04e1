// SPDX-License-Identifier: Apache-2.0
// The process-wide request to stop, set by SIGINT, SIGTERM or SIGHUP (the end of the terminal or of
// the parent). Every loop polls the request, which is never reset. A thread of a group
// (thread_group.h) polls its group's request instead; signals affect threads without a group only.
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
// Number of stop requests, without SIGHUP. Two or more mean "stop now" (a second Ctrl-C).
int StopRequests();
// The first stop signal that arrived; 0 without one, also after RequestStop.
int StopSignal();

// Return value of a main's body that a stop request ended in order. GuardMain (main_guard.h) then
// ends the process by the stop signal. If the request was not a signal, the exit code is 130, which
// shells report for SIGINT.
inline constexpr int kInterruptedExit = 130;

}  // namespace shoal
