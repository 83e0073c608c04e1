// SPDX-License-Identifier: Apache-2.0
// One sentence about where a run's time goes and, if there is one, the change that would make it
// faster. Pure.
#pragma once

#include <string>

#include "launch/watch/bottleneck.h"

namespace shoal::launch {

// Returns an empty text until the learner has worked and kLeastSeconds have been measured, because
// the first shares of a run do not predict later ones.
//
// A change is named only if the programs accept it: no more actors or learner threads than the host
// has cores, no command that a run on several hosts refuses. Keys that the preset chooses on
// purpose (replay.samples_per_insert, learner.batch, ppo.epochs) are never among the changes,
// because these keys change the result of learning.
std::string Advise(const Bottleneck& figures, const RunResources& resources);

inline constexpr double kLeastSeconds = 10;

}  // namespace shoal::launch
