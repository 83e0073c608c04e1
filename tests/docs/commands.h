// SPDX-License-Identifier: Apache-2.0
// The example commands of the pages.
#pragma once

#include <string>
#include <vector>

#include "tests/docs/markdown.h"

namespace shoal {

// A command of a block, or a line of a transcript that begins with "$ ". Lines that go on (a
// backslash at the end, an open quote, a loop until its done) are one command. Comments that stand
// alone are none.
struct Command {
  int line = 0;
  std::string text;  // as written, in one or several lines
};

// Those of one block that shells are shown in: ```sh, or a transcript. None of other blocks.
std::vector<Command> CommandsOf(const Block& block);

// The calls of Shoal's own programs in a text: {"shoal", "train", "--preset", ...}, the words
// up to the end of the command, without the folder before the program; `./run top` is shoal's.
std::vector<std::vector<std::string>> OwnCalls(const std::string& text);

}  // namespace shoal
