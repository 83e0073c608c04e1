// SPDX-License-Identifier: Apache-2.0
// Ctrl-Z on a command whose children have process groups of their own: the terminal tells this
// process alone, which hands it on. Children stop with it and go on with it (`fg`, `bg`), at the
// same moment as far as they can tell: each counts silence only while it runs (liveness_timer.h).
#pragma once

#include <sys/types.h>

#include "common/base/clock.h"

namespace shoal::launch {

// From now on SIGTSTP stops the children that run (ChildProcess), then this process; SIGCONT lets
// all go on. A SIGTSTP that is ignored, as under nohup, stays so.
void SuspendWithChildren();
// From now on SIGTSTP stops nobody, and is counted: processes on other hosts would not stop.
void RefuseSuspension();

// How many times this process has been suspended, and how many times it refused to be.
int Suspensions();
int RefusedSuspensions();

// A clock that stands still while this process is suspended by SIGTSTP.
SteadyTime AwakeNow();

// Children that are stopped and go on with this process; at most 1024, others are left alone. Any
// thread.
void AddSuspended(pid_t child);
void RemoveSuspended(pid_t child);

}  // namespace shoal::launch
