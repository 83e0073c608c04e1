// SPDX-License-Identifier: Apache-2.0
// Maps words of other programs to Shoal's commands and keys.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace shoal::launch {

// Hint for an unknown command: "; shoal film RUN films a policy, ..." if the word is known from
// other programs; otherwise the most similar of `names`; empty if no name is similar.
std::string HintForCommand(const std::string& command, const std::vector<std::string>& names);

// The WordHint (common/base/command_line.h) of `shoal`.
std::string HintForWord(const CLI::App& command, const std::string& word);

// Rewrites the words of a command line. For `train`, an option with the name of a key, or with
// another program's name for the key, becomes --set KEY=VALUE (common/config/meant_key.h). For a
// command whose --json is a flag, "--json -" becomes "--json". Throws Error (usage) for a key
// without a value.
std::vector<std::string> AsCommandsTakeThem(const CLI::App& app, std::vector<std::string> words);

}  // namespace shoal::launch
