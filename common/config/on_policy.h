// SPDX-License-Identifier: Apache-2.0
// Runs that learn on policy: without a replay, from rollouts that go to the learner.
#pragma once

#include "common/config/config.h"

namespace shoal {

bool LearnsOnPolicy(const Config& config);

// Throws Error (kUsage) naming a key that the run's kind of learning has no use for and that is not
// at its default, with what would fit; and a rollout that cannot be learned from.
void ValidateOnPolicy(const Config& config);

}  // namespace shoal
