// SPDX-License-Identifier: Apache-2.0
// A command line as plain text: what --help says, as values that man pages and completions are
// written from.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace shoal::launch {

// A word that may be typed, and what it means; the meaning may be empty.
struct Word {
  std::string word, meaning;
};

struct OptionText {
  std::string name;                // "-h,--help"; of an argument without a flag "task"
  std::vector<std::string> flags;  // "-h", "--help"; empty for an argument without a flag
  std::string takes;               // as --help has it: "TEXT REQUIRED", "INT=480"; may be empty
  std::string meaning;
  bool takes_value = false;
  std::vector<Word> values;  // those that are known; empty = any text, number or file
};

struct CommandText {
  std::string name;  // "shoal env render"
  std::string meaning;
  std::string usage;  // "shoal env render [OPTIONS] [task]"
  std::vector<OptionText> options;
  std::vector<CommandText> commands;
};

// The whole tree below a program's or a command's App. `name`: "shoal".
CommandText DescribeCommand(const CLI::App& app, const std::string& name);

// The command and all below it, in the order of --help. Borrows.
std::vector<const CommandText*> AllCommands(const CommandText& command);

}  // namespace shoal::launch
