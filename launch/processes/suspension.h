// SPDX-License-Identifier: Apache-2.0
// Ctrl-Z on a command whose children have process groups of their own: the terminal signals only
// this process, which forwards the signal. Children stop and continue together with it (`fg`,
// `bg`). Each counts silence only while it runs (liveness_timer.h), so that they do not take each
// other for dead.
#pragma once

#include <sys/types.h>

#include "common/base/clock.h"

namespace shoal::launch {

// From now on SIGTSTP stops the running children (ChildProcess), then this process; SIGCONT
// continues all. A SIGTSTP that is ignored, as under nohup, stays ignored.
void SuspendWithChildren();
// From now on SIGTSTP stops no process and is counted: processes on other hosts would not stop.
void RefuseSuspension();

// Number of times that this process was suspended, and that it refused to be.
int Suspensions();
int RefusedSuspensions();

// A clock that stands still while this process is suspended by SIGTSTP.
SteadyTime AwakeNow();

// Children that are stopped and continued with this process; at most 1024, others are ignored. Any
// thread.
void AddSuspended(pid_t child);
void RemoveSuspended(pid_t child);

}  // namespace shoal::launch
