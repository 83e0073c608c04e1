// SPDX-License-Identifier: Apache-2.0
// Words that users of other programs type, and what they are called here.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace shoal::launch {

// "; shoal film RUN films a policy, ..." of a command that there is not; else the nearest of
// `names`; else empty.
std::string HintForCommand(const std::string& command, const std::vector<std::string>& names);

// A WordHint (common/base/command_line.h) of `shoal`.
std::string HintForWord(const CLI::App& command, const std::string& word);

// The words of a command line as its commands take them: of `train` each option that is a key's
// name, or another program's name for it, as --set KEY=VALUE (common/config/meant_key.h); of a
// command whose --json is a flag, "--json -" as "--json". Throws Error (usage) for a key without a
// value.
std::vector<std::string> AsCommandsTakeThem(const CLI::App& app, std::vector<std::string> words);

}  // namespace shoal::launch
