// SPDX-License-Identifier: Apache-2.0
// Runs that learn on policy: they have no replay, and actors send rollouts to the learner.
#pragma once

#include "common/config/config.h"

namespace shoal {

bool LearnsOnPolicy(const Config& config);

// Checks the keys against the run's kind of learning. Throws Error (kUsage) if a key that this kind
// does not use is not at its default (the error names the key and a valid choice), or if no update
// is possible from the configured rollout.
void ValidateOnPolicy(const Config& config);

}  // namespace shoal
