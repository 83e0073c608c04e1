// SPDX-License-Identifier: Apache-2.0
// Test of a user's environment before a run uses it. Checks that the environment conforms to its
// description and that equal seeds give equal episodes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "actor/hosted/raw_environment.h"
#include "common/tasks/environment_description.h"

namespace shoal::hosted {

struct Trial {
  int steps = 0;                    // steps played
  double step_microseconds = 0;     // duration of one step
  bool success = false;             // the environment reports success
  int repeated_steps = 0;           // steps repeated with the same seed and actions
  std::optional<int> differs_at{};  // first repeated step that differs; 0 = the reset
  std::string other_reward{};  // first reward that contradicts the description's goal; empty = none
};

// Plays random actions until an episode ends or two seconds have passed, then repeats the beginning
// of the episode. Throws the environment's errors.
Trial TryEnvironment(RawEnvironment& environment, const tasks::EnvironmentDescription& description,
                     uint64_t seed);

}  // namespace shoal::hosted
