// SPDX-License-Identifier: Apache-2.0
// How many threads learn, and whether the batch can be shared among them.
#pragma once

#include <string_view>

#include "common/base/usable_cores.h"
#include "common/config/config.h"

namespace shoal {

// learner.threads. If it is 0: half of `cores`, at least 1; off policy three quarters, rounded up,
// if an update follows every eighth env step or more often, and all if one follows each: then
// actors mostly wait. How often updates follow is the mean of replay.samples_per_insert over the
// budget of env steps. Off policy at most as many as have 16 rows of the batch each; without pixels
// 1, because updates are too short to wait for each other.
int LearnerThreads(const Config& config, int cores);

// Threads that have enough rows of a batch to be worth a core: 8 each, transitions whole.
int MostThreads(const Config& config);

// Throws Error (kUsage) unless there is a transition of learner.batch, with its replay.copies, for
// each of so many replicas.
void CheckReplicas(const Config& config, int replicas);

// Throws Error (kUsage) unless the `threads` that the key asks for have a core each: threads of one
// update, or of one batch, wait for each other, so that more of them than cores are slower than one
// per core. The error says what limits the cores. `limits` are those of the threads' host.
void CheckCores(std::string_view key, int threads, const CoreLimits& limits);

}  // namespace shoal
