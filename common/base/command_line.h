// SPDX-License-Identifier: Apache-2.0
// Command lines of all programs: --version, and one line for each error.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace shoal {

// --version prints one line, "NAME VERSION (COMMIT), licence Apache-2.0". NAME is the app's.
void AddVersion(CLI::App* app);

// A hint for a word, or an option with its dashes, that `command` does not take: "; it is a preset:
// --preset X". If the hint for an option is empty, the error names the nearest option of the
// command.
using WordHint = std::function<std::string(const CLI::App& command, const std::string& word)>;

// The exit code, if help or the version was requested and has been printed; empty if the program
// continues. Throws Error (usage) for unknown options and words, naming the command, the option or
// word, and the nearest known one. `words`: without the program's own name.
std::optional<int> ParseCommandLine(CLI::App* app, const std::vector<std::string>& words,
                                    const WordHint& hint = nullptr);
std::optional<int> ParseCommandLine(CLI::App* app, int argc, char** argv);

}  // namespace shoal
