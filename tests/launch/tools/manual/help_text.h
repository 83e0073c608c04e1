// SPDX-License-Identifier: Apache-2.0
// The --help output of the built programs, parsed: a reference for man pages and completions that
// does not depend on their generator.
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

// Path of the built file build/share/FILE.
std::string SharePath(const std::string& file);

}  // namespace shoal
