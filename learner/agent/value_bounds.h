// SPDX-License-Identifier: Apache-2.0
// Bounds of a value if every reward is -1 or 0 (sparse goals): from -1 / (1 - discount) to 0, times
// the scale of rewards. A target that is clipped to these bounds cannot diverge (Eq. 20 of
// docs/algorithm.md).
#pragma once

#include "common/config/config.h"
#include "common/config/run_config.h"
#include "learner/engine/losses.h"

namespace shoal::learner {

// Returns the bounds if learner.bounded_targets is set, otherwise no bounds.
ValueBounds ValueBoundsOf(const LearnerConfig& learner);

// Throws Error (kUsage) if learner.bounded_targets is set, but rewards are not -1 and 0 or values
// have no bound.
void CheckValueBounds(const RunConfig& run);

}  // namespace shoal::learner
