// SPDX-License-Identifier: Apache-2.0
// How many threads learn, and whether the batch can be shared among them.
#pragma once

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

}  // namespace shoal
