// SPDX-License-Identifier: Apache-2.0
// Makes the timed waits of the DDS library independent of changes of the wall clock. Internal.
//
// Cyclone DDS 0.10.2 waits on condition variables until a wall-clock time. If the clock is set back
// by an hour during a wait of 100 ms, Cyclone's event thread sleeps for an hour: no heartbeats, no
// retransmissions, no discovery. The program therefore defines its own pthread_cond_timedwait,
// which the dynamic linker prefers to the function in libc. Shoal's function converts the
// wall-clock time to a duration at the time of the call, and waits for this duration on the steady
// clock.
#pragma once

namespace shoal::dds {

// CHECKs that libc's pthread_cond_timedwait is not in use. A call of this function also links
// Shoal's pthread_cond_timedwait into the program. A module that another program loads (the Python
// package's actor) is loaded after libc. For such a module, LD_PRELOAD must load a library with
// Shoal's function before libc.
void RequireSteadyWaits();

// Does nothing. A reference to this function links timed_wait.cpp into the program.
void LinkTimedWait();

}  // namespace shoal::dds
