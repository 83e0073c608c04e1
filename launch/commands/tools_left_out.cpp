// SPDX-License-Identifier: Apache-2.0
// The tools' commands in a build with SHOAL_TOOLS=OFF: each is refused.
#include <fmt/ranges.h>

#include <algorithm>

#include "common/base/error.h"
#include "launch/commands/tool_commands.h"

namespace shoal::launch {

void AddToolCommands(CLI::App& /*app*/, Action* /*chosen*/) {}

void CheckToolsAreBuilt(const std::vector<std::string>& words) {
  for (const std::vector<std::string>& tool : kToolCommands) {
    if (words.size() < tool.size() || !std::equal(tool.begin(), tool.end(), words.begin())) {
      continue;
    }
    throw UsageError(
        "shoal {}: not part of this build; configure Shoal with -DSHOAL_TOOLS=ON to have it",
        fmt::join(tool, " "));
  }
}

}  // namespace shoal::launch
