// What tasks are: env list, env describe.
#pragma once

#include "launch/commands/commands.h"

namespace shoal::launch {

void AddEnvTaskCommands(CLI::App& env, Action* chosen);

}  // namespace shoal::launch
