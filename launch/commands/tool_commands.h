// SPDX-License-Identifier: Apache-2.0
// The commands of launch/tools, which a build may leave out (CMake option SHOAL_TOOLS).
//
// Two sources implement this header: launch/tools/commands/tool_commands.cpp with the tools, and
// launch/commands/tools_left_out.cpp without the tools. A program links one of the two, so that
// launch/commands includes nothing of launch/tools.
#pragma once

#include <string>
#include <vector>

#include "launch/commands/commands.h"

namespace shoal::launch {

// Words of each tool's command. Some commands are sub-commands of a command that every build has.
inline const std::vector<std::vector<std::string>> kToolCommands = {
    {"card"}, {"compare"}, {"env", "observability"}, {"experiment"}, {"export"}, {"film"},
    {"new"},  {"plot"},    {"replay", "export"},     {"report"},     {"web"}};

// Adds the tools' commands. The command line must already have all other commands. Adds nothing if
// the build lacks the tools.
void AddToolCommands(CLI::App& app, Action* chosen);

// If the build lacks the tools and `words` begin with a tool's command, throws Error (usage) naming
// SHOAL_TOOLS. Does nothing if the build has the tools.
void CheckToolsAreBuilt(const std::vector<std::string>& words);

}  // namespace shoal::launch
