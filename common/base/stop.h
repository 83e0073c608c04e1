// SPDX-License-Identifier: Apache-2.0
// The process-wide stop request. SIGINT, SIGTERM or SIGHUP (the terminal was closed, or the parent
// died) sets the request. Every loop polls the request. The request is never reset. A thread of a
// group (thread_group.h) polls its group's request instead; signals affect only threads without a
// group.
#pragma once

#include <atomic>

namespace shoal {

// Installs handlers for SIGINT, SIGTERM and SIGHUP that request a stop, and ignores SIGPIPE. If
// SIGHUP is ignored at the start (nohup), it stays ignored. SIGHUP does not count as one of the
// StopRequests, because the kernel sends it once for each thread of a parent that died; otherwise
// it would mean "stop now".
void InstallStopSignals();
// Requests a stop. Async-signal-safe.
void RequestStop();
bool StopRequested();
// Number of stop requests, without SIGHUP. Two or more mean "stop now" (a second Ctrl-C).
int StopRequests();
// The first stop signal that arrived. 0 if no signal arrived, even if RequestStop was called.
int StopSignal();

// The body of a main returns this value if a stop request ended it in order. GuardMain
// (main_guard.h) then ends the process by the stop signal. If the request was not a signal, the
// exit code is 130, which shells report for SIGINT.
inline constexpr int kInterruptedExit = 130;

}  // namespace shoal
