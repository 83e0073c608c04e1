// SPDX-License-Identifier: Apache-2.0
// How many threads learn, and whether the batch can be shared among them.
#pragma once

#include "common/base/usable_cores.h"
#include "common/config/config.h"

namespace shoal {

// learner.threads, or where it is 0 half of `cores`, at least 1; off policy three quarters, rounded
// up, where an update follows every eighth env step or more often, and all where it follows each:
// then actors mostly wait. How often that is goes by the mean of replay.samples_per_insert over the
// budget of env steps. Off policy, where threads are replicas as a rule: the largest number up to
// there that leaves each an equal part of the batch of at least 16 rows; without pixels 1, as
// updates are too short to wait for each other.
int LearnerThreads(const Config& config, int cores);

// Throws Error (kUsage) naming the numbers that would fit unless so many replicas can share
// learner.batch: in equal parts that split no replay.copies of one transition.
void CheckReplicas(const Config& config, int replicas);

// Throws Error (kUsage) unless `threads` have a core each: threads of one update wait for each
// other, so that more of them learn more slowly than one per core. The error says what limits the
// cores. `limits` are the learner's host's.
void CheckCores(int threads, const CoreLimits& limits);

}  // namespace shoal
