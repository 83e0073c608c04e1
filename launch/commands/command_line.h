// SPDX-License-Identifier: Apache-2.0
// The command line of `shoal`, whole: what main parses and what the manual is made from.
#pragma once

#include <memory>

#include "launch/commands/commands.h"

namespace shoal::launch {

// Parsing stores what to do in `*chosen`, which must outlive the command line.
std::unique_ptr<CLI::App> MakeCommandLine(Action* chosen);

// Parses the command line and runs the command it names; the exit code. Throws Error.
int RunCommandLine(int argc, char** argv);

}  // namespace shoal::launch
