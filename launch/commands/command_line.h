// SPDX-License-Identifier: Apache-2.0
// The complete command line of `shoal`. main parses it, and the manual is generated from it.
#pragma once

#include <memory>

#include "launch/commands/commands.h"

namespace shoal::launch {

// Parsing stores the action of the user's command in `*chosen`, which must outlive the command
// line.
std::unique_ptr<CLI::App> MakeCommandLine(Action* chosen);

// Parses the command line, runs its command and returns the exit code. Throws Error.
int RunCommandLine(int argc, char** argv);

}  // namespace shoal::launch
