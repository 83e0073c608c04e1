// SPDX-License-Identifier: Apache-2.0
// Completion of command lines in three shells. Each script has a table of the possible words at
// each place, with their meanings, and a few lines of shell code that search this table.
#pragma once

#include <string>
#include <vector>

#include "launch/tools/manual/command_text.h"

namespace shoal::launch {

enum class Shell { kBash, kZsh, kFish };

// One script for all programs.
std::string CompletionScript(Shell shell, const std::vector<CommandText>& programs);

}  // namespace shoal::launch
