// SPDX-License-Identifier: Apache-2.0
// A user's environment, tried before a run uses it: does it keep to what it says, and do equal
// seeds give equal episodes?
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "actor/hosted/raw_environment.h"
#include "common/tasks/environment_description.h"

namespace shoal::hosted {

struct Trial {
  int steps = 0;                    // that were played
  double step_microseconds = 0;     // duration of one
  bool success = false;             // a step said whether it succeeds
  int repeated_steps = 0;           // that were played again with the same seed and actions
  std::optional<int> differs_at{};  // the first that was another the second time; 0 = the reset
  std::string other_reward{};  // why the description's goal does not give the rewards; or empty
};

// Plays random actions until an episode ends or two seconds are over, and its beginning again.
// Throws what the environment throws.
Trial TryEnvironment(RawEnvironment& environment, const tasks::EnvironmentDescription& description,
                     uint64_t seed);

}  // namespace shoal::hosted
