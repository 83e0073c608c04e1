// SPDX-License-Identifier: Apache-2.0
// How every program of ours takes its command line: --version, and one line for what is wrong.
#pragma once

#include <optional>

namespace CLI {
class App;
}

namespace shoal {

// --version prints one line, "NAME VERSION (COMMIT), licence Apache-2.0". NAME is the app's.
void AddVersion(CLI::App* app);

// The exit code where help or the version was asked for and has been printed; nothing where the
// program goes on. Throws Error (usage) for what the app does not take.
std::optional<int> ParseCommandLine(CLI::App* app, int argc, char** argv);

}  // namespace shoal
