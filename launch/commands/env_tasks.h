// SPDX-License-Identifier: Apache-2.0
// Commands about tasks: env list, env describe, env random, env reward-check.
#pragma once

#include "launch/commands/commands.h"

namespace shoal::launch {

void AddEnvTaskCommands(CLI::App& env, Action* chosen);

// Command env check (env_check.cpp), for environments of Python.
void AddEnvCheckCommand(CLI::App& env, Action* chosen);

}  // namespace shoal::launch
