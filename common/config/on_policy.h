// SPDX-License-Identifier: Apache-2.0
// Runs that learn on policy: they have no replay, and actors send rollouts to the learner.
#pragma once

#include "common/config/config.h"

namespace shoal {

bool LearnsOnPolicy(const Config& config);

// Checks the keys against the run's kind of learning (on policy or off policy). Throws Error
// (kUsage) if a key is set that this kind of learning does not use; the error names the key and a
// valid choice. Also throws if the configured rollout is too small for an update.
void ValidateOnPolicy(const Config& config);

}  // namespace shoal
