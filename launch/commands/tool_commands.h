// SPDX-License-Identifier: Apache-2.0
// The commands of launch/tools, which a build may leave out (CMake option SHOAL_TOOLS).
//
// Two sources implement this header: launch/tools/commands/tool_commands.cpp with the tools, and
// launch/commands/tools_left_out.cpp without them. A program links one of the two, so that
// launch/commands includes nothing of launch/tools.
#pragma once

#include <string>
#include <vector>

#include "launch/commands/commands.h"

namespace shoal::launch {

// Words of each tool's command. Some are sub-commands of a command that every build has.
inline const std::vector<std::vector<std::string>> kToolCommands = {
    {"card"}, {"compare"}, {"env", "observability"}, {"experiment"}, {"export"}, {"film"},
    {"new"},  {"plot"},    {"replay", "export"},     {"report"},     {"web"}};

// Adds the tools' commands. The command line must have all others already. Without the tools,
// adds nothing.
void AddToolCommands(CLI::App& app, Action* chosen);

// Throws Error (usage) that names SHOAL_TOOLS if the build lacks the tools and a command line that
// starts with `words` calls one. Does nothing if the build has the tools.
void CheckToolsAreBuilt(const std::vector<std::string>& words);

}  // namespace shoal::launch
