// SPDX-License-Identifier: Apache-2.0
// The example commands of the pages.
#pragma once

#include <string>
#include <vector>

#include "tests/docs/markdown.h"

namespace shoal {

// A command of a block, or a line of a transcript that begins with "$ ". Continued lines (a
// backslash at the end, an open quote, a loop up to its `done`) form one command. Comment lines are
// skipped.
struct Command {
  int line = 0;
  std::string text;  // unchanged, in one or several lines
};

// The commands of a ```sh block or a transcript; empty for other blocks.
std::vector<Command> CommandsOf(const Block& block);

// The calls of Shoal's programs in a text, as words: {"shoal", "train", "--preset", ...}. The
// folder of the program is removed; `./run top` counts as a call of shoal.
std::vector<std::vector<std::string>> OwnCalls(const std::string& text);

}  // namespace shoal
