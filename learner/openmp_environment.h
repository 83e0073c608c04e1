// SPDX-License-Identifier: Apache-2.0
// OpenMP's settings, which libgomp reads when it is loaded, long before main.
#pragma once

namespace shoal::learner {

// Starts the program anew, once, with OMP_WAIT_POLICY=passive and OMP_NUM_THREADS=`threads` when
// OMP_WAIT_POLICY is not set (the launcher sets both): spinning OpenMP threads would take the cores
// from actors. Returns when there is nothing to do. Call before any thread is made. Throws Error
// when the program cannot be started anew.
void EnsurePassiveOpenMp(int threads, char** argv);

}  // namespace shoal::learner
