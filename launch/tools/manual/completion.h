// SPDX-License-Identifier: Apache-2.0
// Completion of command lines in three shells. Each script has one table: what may stand where,
// with its meaning; and a few lines of the shell that look into it.
#pragma once

#include <string>
#include <vector>

#include "launch/tools/manual/command_text.h"

namespace shoal::launch {

enum class Shell { kBash, kZsh, kFish };

// One script for all programs.
std::string CompletionScript(Shell shell, const std::vector<CommandText>& programs);

}  // namespace shoal::launch
