// SPDX-License-Identifier: Apache-2.0
// Keys of a run with a user's environment (env.id), in Python or in a C++ library. Some keys follow
// from the name. Others follow from the environment's spaces, unless the user sets these keys.
#pragma once

#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/tasks/environment_description.h"

namespace shoal::launch {

// Does nothing if env.id is empty. Otherwise completes `config`: makes a file in env.id an absolute
// path, sets the task's name and, for an environment of Python, env.python and env.folder. Throws
// Error (kUsage) if a file or an interpreter does not exist.
void CompleteEnvironmentKeys(Config* config);

// The settings of a run that the user's preset, file and --set do not contain.
struct EnvironmentDefaults {
  std::string preset;                    // "state" or "pixels"; used if the user names no preset
  std::vector<std::string> assignments;  // "observation.grey=true"
  std::string reason;                    // reason for the preset, for people
};

EnvironmentDefaults DefaultsFor(const tasks::EnvironmentDescription& environment);

}  // namespace shoal::launch
