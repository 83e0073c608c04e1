// SPDX-License-Identifier: Apache-2.0
// Ctrl-Z on a command whose children have process groups of their own: the terminal signals only
// this process, which forwards the signal. Children stop and continue together with it (`fg`,
// `bg`). The liveness timer of each process advances only while the process runs
// (liveness_timer.h), so no process counts another as dead.
#pragma once

#include <sys/types.h>

#include "common/base/clock.h"

namespace shoal::launch {

// From now on SIGTSTP stops the running children (ChildProcess), then this process; SIGCONT
// continues all. If SIGTSTP was ignored, as under nohup, it stays ignored.
void SuspendWithChildren();
// From now on SIGTSTP is counted and stops no process, because processes on other hosts would not
// stop.
void RefuseSuspension();

// Number of suspensions of this process, and number of refused suspensions.
int Suspensions();
int RefusedSuspensions();

// A clock that stands still while this process is suspended by SIGTSTP.
SteadyTime AwakeNow();

// Adds or removes a child that is stopped and continued with this process. At most 1024 children;
// further ones are ignored. Any thread.
void AddSuspended(pid_t child);
void RemoveSuspended(pid_t child);

}  // namespace shoal::launch
