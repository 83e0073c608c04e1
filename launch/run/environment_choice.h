// SPDX-License-Identifier: Apache-2.0
// Runs of a user's environment (env.id), in Python or of a library in C++: the keys that follow
// from the name, and those that follow from the environment's spaces unless the user sets them.
#pragma once

#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/tasks/environment_description.h"

namespace shoal::launch {

// Without env.id nothing. Else completes `config`: a file in env.id as an absolute path, the task's
// name, and of an environment of Python env.python and env.folder. Throws Error (kUsage) on a file
// or an interpreter that does not exist.
void CompleteEnvironmentKeys(Config* config);

// The settings that a run gets where the user's preset, file and --set do not say them.
struct EnvironmentDefaults {
  std::string preset;                    // "state" or "pixels"; only where none is named
  std::vector<std::string> assignments;  // "observation.grey=true"
  std::string reason;                    // of the preset, for people
};

EnvironmentDefaults DefaultsFor(const tasks::EnvironmentDescription& environment);

}  // namespace shoal::launch
