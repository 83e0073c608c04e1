// SPDX-License-Identifier: Apache-2.0
// Properties of prioritised sampling (replay.priorities) that learner and replay use.
#pragma once

#include "common/config/config.h"

namespace shoal {

// Whether samples are drawn by priorities.
inline bool HasPriorities(const ReplayConfig& replay) { return replay.priorities != "none"; }

// Whether importance weights correct the critic's loss for the probabilities of draws.
inline bool HasImportanceWeights(const ReplayConfig& replay) {
  return replay.priorities == "proportional";
}

}  // namespace shoal
