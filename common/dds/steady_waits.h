// SPDX-License-Identifier: Apache-2.0
// Makes the DDS library's timed waits immune to the wall clock being set. Internal.
//
// Cyclone DDS 0.10.2 waits on condition variables until a wall-clock time. If the clock is set back
// by an hour during a wait of 100 ms, its event thread sleeps for an hour: no heartbeats, no
// retransmissions, no discovery. The program therefore defines its own pthread_cond_timedwait,
// which the dynamic linker prefers to libc's. This function converts the wall-clock time into a
// span when it is called, and waits for the span on the steady clock.
#pragma once

namespace shoal::dds {

// CHECKs that libc's pthread_cond_timedwait is not in use. A call of this function also links
// Shoal's version into the program. A module that another program loads (the Python package's
// actor) is loaded after libc; there, LD_PRELOAD loads a library with Shoal's version first.
void RequireSteadyWaits();

// Does nothing. A reference to this function links timed_wait.cpp into the program.
void LinkTimedWait();

}  // namespace shoal::dds
