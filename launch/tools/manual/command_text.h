// SPDX-License-Identifier: Apache-2.0
// A command line as plain text: the content of --help as values. Man pages and completions are
// written from these values.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace shoal::launch {

// A word that can be typed, and its meaning, which may be empty.
struct Word {
  std::string word, meaning;
};

struct OptionText {
  std::string name;                // "-h,--help"; for an argument without a flag: "task"
  std::vector<std::string> flags;  // "-h", "--help"; empty for an argument without a flag
  std::string takes;               // as in --help: "TEXT REQUIRED", "INT=480"; may be empty
  std::string meaning;
  bool takes_value = false;
  std::vector<Word> values;  // possible values; empty = any text, number or file
};

struct CommandText {
  std::string name;  // "shoal env render"
  std::string meaning;
  std::string usage;  // "shoal env render [OPTIONS] [task]"
  std::vector<OptionText> options;
  std::vector<CommandText> commands;
};

// Describes the App of a program or command and all commands below it. `name`: "shoal".
CommandText DescribeCommand(const CLI::App& app, const std::string& name);

// The command and all commands below it, in the order of --help. The result borrows from `command`.
std::vector<const CommandText*> AllCommands(const CommandText& command);

}  // namespace shoal::launch
