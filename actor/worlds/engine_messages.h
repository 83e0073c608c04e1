// SPDX-License-Identifier: Apache-2.0
// MuJoCo's error and warning callbacks, one pair per process.
#pragma once

#include <cstdint>

namespace shoal::worlds {

// Idempotent. From then on an engine error is thrown as Error; a warning is counted and logged: the
// first of each text, then whenever its count doubles. Without this the engine would exit the
// process, and write a file in the current folder.
void InstallEngineCallbacks();

// Warnings since the process started, all environments together.
int64_t EngineWarnings();

}  // namespace shoal::worlds
