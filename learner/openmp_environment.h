// SPDX-License-Identifier: Apache-2.0
// OpenMP's settings, which libgomp reads when it is loaded, long before main.
#pragma once

namespace shoal::learner {

// Restarts the program once with OMP_WAIT_POLICY=passive and OMP_NUM_THREADS=`threads` if
// OMP_WAIT_POLICY is not set (the launcher sets both), because spinning OpenMP threads would take
// cores from actors. Otherwise returns at once. Call it before any thread is created. Throws Error
// if the program cannot be restarted.
void EnsurePassiveOpenMp(int threads, char** argv);

}  // namespace shoal::learner
