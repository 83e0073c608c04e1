// More commands of `shoal`: as commands.h has it.
#pragma once

#include "launch/commands/commands.h"

namespace shoal::launch {

void AddConfigCommand(CLI::App& app, Action* chosen);
void AddNewCommand(CLI::App& app, Action* chosen);

}  // namespace shoal::launch
