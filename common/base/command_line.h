// SPDX-License-Identifier: Apache-2.0
// How every program of ours takes its command line: --version, and one line for what is wrong.
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

// What a program knows of a word, or an option with its dashes, that `command` does not take:
// "; it is a preset: --preset X". Empty where it knows nothing; of an option the nearest one of the
// command is named then.
using WordHint = std::function<std::string(const CLI::App& command, const std::string& word)>;

// The exit code where help or the version was asked for and has been printed; nothing where the
// program goes on. Throws Error (usage) for what the app does not take, naming the command, the
// option or word, and what is near it. `words`: without the program's own name.
std::optional<int> ParseCommandLine(CLI::App* app, const std::vector<std::string>& words,
                                    const WordHint& hint = nullptr);
std::optional<int> ParseCommandLine(CLI::App* app, int argc, char** argv);

}  // namespace shoal
