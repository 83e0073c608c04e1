// SPDX-License-Identifier: Apache-2.0
// Number of the learner's threads, and checks that the batch can be divided among them.
#pragma once

#include "common/config/config.h"

namespace shoal {

// learner.threads or, if this key is 0, a number computed from `cores`:
//
// - On a GPU (learner.device = cuda): 1, which submits the GPU's work.
// - On policy: half of the cores, at least 1.
// - Off policy: half of the cores, at least 1. If there is at least one update for every eight env
//   steps, three quarters, rounded up. If there is at least one update for each env step, all
//   cores, because the actors mostly wait. The rate of updates is the mean of
//   replay.samples_per_insert over the budget of env steps. Each thread must have at least 16 rows
//   of the batch.
// - Off policy without pixels: 1, because updates are too short for threads to wait for each other,
//   except those of sequences (mrq).
int LearnerThreads(const Config& config, int cores);

// Largest useful number of threads. Each thread must have at least 8 rows of a batch, and all
// copies of a transition must belong to one thread.
int MostThreads(const Config& config);

// Throws Error (kUsage) unless learner.batch has at least one transition, with all its copies
// (replay.copies), for each replica.
void CheckReplicas(const Config& config, int replicas);

}  // namespace shoal
