// SPDX-License-Identifier: Apache-2.0
// Ctrl-Z on a command whose children have their own process groups. The terminal signals only this
// process, which forwards the signal. The children stop and continue (`fg`, `bg`) together with
// this process. The liveness timer of each process advances only while the process runs
// (liveness_timer.h), so no process counts another as dead.
#pragma once

#include <sys/types.h>

#include "common/base/clock.h"

namespace shoal::launch {

// From now on SIGTSTP stops the running children (ChildProcess), then this process; SIGCONT
// continues all of them. If SIGTSTP was ignored before, as under nohup, SIGTSTP stays ignored.
void SuspendWithChildren();
// From now on SIGTSTP is counted and stops no process, because processes on other hosts would not
// stop.
void RefuseSuspension();

// Number of suspensions of this process.
int Suspensions();
// Number of refused suspensions.
int RefusedSuspensions();

// A clock that does not advance while this process is suspended by SIGTSTP.
SteadyTime AwakeNow();

// Adds or removes a child that is stopped and continued with this process. There are at most 1024
// such children; further children are ignored. Any thread.
void AddSuspended(pid_t child);
void RemoveSuspended(pid_t child);

}  // namespace shoal::launch
