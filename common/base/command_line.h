// SPDX-License-Identifier: Apache-2.0
// Parsing of command lines, for all programs: --version, and one line for each error.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace shoal {

// Adds --version, which prints one line: "NAME VERSION (COMMIT), licence Apache-2.0". NAME is the
// app's name.
void AddVersion(CLI::App* app);

// Returns a hint for a word (or an option with its dashes) that `command` does not accept. Example:
// "; it is a preset: --preset X". If the hint for an option is empty, the error names the nearest
// option of the command.
using WordHint = std::function<std::string(const CLI::App& command, const std::string& word)>;

// Parses `words`, which do not contain the program's own name. If help or the version was
// requested, prints the text and returns the exit code; otherwise returns empty, and the program
// continues. If an option or a word is unknown, throws Error (kUsage) that names the command, the
// option or word, and the nearest known option or word.
std::optional<int> ParseCommandLine(CLI::App* app, const std::vector<std::string>& words,
                                    const WordHint& hint = nullptr);
std::optional<int> ParseCommandLine(CLI::App* app, int argc, char** argv);

}  // namespace shoal
