// SPDX-License-Identifier: Apache-2.0
// Settings of OpenMP in environment variables. libgomp reads these variables when it is loaded,
// before main begins.
#pragma once

namespace shoal::learner {

// If OMP_WAIT_POLICY is not set, restarts the program once with OMP_WAIT_POLICY=passive and
// OMP_NUM_THREADS=`threads`. Without these settings, waiting OpenMP threads spin and take cores
// from actors. The launcher sets the two variables, so that no restart is necessary. Call this
// function before other threads exist. Throws Error if the program cannot be restarted.
void EnsurePassiveOpenMp(int threads, char** argv);

}  // namespace shoal::learner
