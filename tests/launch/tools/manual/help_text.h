// SPDX-License-Identifier: Apache-2.0
// The --help of the built programs, parsed from their output: the reference for man pages and
// completions, independent of the code that makes them.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace shoal {

struct HelpText {
  std::vector<std::string> words;  // {"shoal", "env", "render"}
  std::string description;         // its first line
  std::set<std::string> flags;     // "-h", "--help", "--camera"
  std::set<std::string> arguments;
  std::set<std::string> commands;

  std::string name() const;  // "shoal env render"
};

// The help of a program and each of its commands, as `PROGRAM ... --help` prints it.
const std::vector<HelpText>& AllHelp();

// build/share/FILE as the build made it.
std::string SharePath(const std::string& file);

}  // namespace shoal
