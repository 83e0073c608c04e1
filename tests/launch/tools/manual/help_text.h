// SPDX-License-Identifier: Apache-2.0
// The parsed --help output of the built programs. It is a reference for man pages and completions
// that does not depend on their generator.
#pragma once

#include <set>
#include <string>
#include <vector>

namespace shoal {

struct HelpText {
  std::vector<std::string> words;  // {"shoal", "env", "render"}
  std::string description;         // first line of the description
  std::set<std::string> flags;     // "-h", "--help", "--camera"
  std::set<std::string> arguments;
  std::set<std::string> commands;

  std::string name() const;  // "shoal env render"
};

// The help of every program and of all its commands, from `PROGRAM ... --help`.
const std::vector<HelpText>& AllHelp();

// Path of the built file build/share/FILE.
std::string SharePath(const std::string& file);

}  // namespace shoal
