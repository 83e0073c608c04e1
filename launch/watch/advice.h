// SPDX-License-Identifier: Apache-2.0
// One sentence about the use of a run's time and, if there is one, about a change that would make
// the run faster. Pure.
#pragma once

#include <string>

#include "launch/watch/bottleneck.h"

namespace shoal::launch {

// Returns an empty text until the learner has worked and kLeastSeconds have been measured, because
// the first shares of a run do not predict later shares.
//
// The sentence names a change only if the programs accept the change: no more actors or learner
// threads than the host has cores, no command that a run on several hosts refuses. Keys that change
// the result of learning (replay.samples_per_insert, learner.batch, ppo.epochs) are never among the
// changes.
std::string Advise(const Bottleneck& figures, const RunResources& resources);

inline constexpr double kLeastSeconds = 10;

}  // namespace shoal::launch
