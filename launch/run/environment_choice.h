// SPDX-License-Identifier: Apache-2.0
// Runs of a user's environment (env.id), in Python or of a library in C++: the keys that follow
// from the name, and those that follow from the environment's spaces unless the user sets them.
#pragma once

#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/tasks/environment_description.h"

namespace shoal::launch {

// Does nothing without env.id. Else completes `config`: makes a file in env.id an absolute path,
// and sets the task's name and, for an environment of Python, env.python and env.folder. Throws
// Error (kUsage) if a file or an interpreter does not exist.
void CompleteEnvironmentKeys(Config* config);

// The settings of a run that the user's preset, file and --set do not contain.
struct EnvironmentDefaults {
  std::string preset;                    // "state" or "pixels"; used only if the user names none
  std::vector<std::string> assignments;  // "observation.grey=true"
  std::string reason;                    // of the preset, for people
};

EnvironmentDefaults DefaultsFor(const tasks::EnvironmentDescription& environment);

}  // namespace shoal::launch
