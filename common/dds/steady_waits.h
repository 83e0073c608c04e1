// SPDX-License-Identifier: Apache-2.0
// Makes the DDS library's timed waits immune to the wall clock being set. Internal.
//
// Cyclone DDS 0.10.2 waits on condition variables until a wall-clock time. Its event thread
// computes "in 100 ms" and, when the clock is then set back by an hour, sleeps for an hour: no
// heartbeats, no retransmissions, no discovery. The program therefore brings a
// pthread_cond_timedwait of its own, which the library finds before libc's: it turns the time into
// a span at once and waits for that on the steady clock.
#pragma once

namespace shoal::dds {

// CHECKs that libc's version is not the one in use. Also what links ours into a program. A module
// that another program loads (the Python package's actor) comes after libc: there the loader brings
// in a library of ours before, by LD_PRELOAD.
void RequireSteadyWaits();

// Links timed_wait.cpp; does nothing.
void LinkTimedWait();

}  // namespace shoal::dds
