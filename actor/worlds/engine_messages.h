// SPDX-License-Identifier: Apache-2.0
// MuJoCo's error and warning callbacks, one pair per process.
#pragma once

#include <cstdint>

namespace shoal::worlds {

// Installs the callbacks; idempotent. Engine errors are then thrown as Error. Warnings are counted
// by text. A warning is logged when its text first appears and whenever the count of the text
// doubles. Without the callbacks the engine would end the process and write a file to the current
// folder.
void InstallEngineCallbacks();

// Number of warnings since the process started, over all environments.
int64_t EngineWarnings();

}  // namespace shoal::worlds
