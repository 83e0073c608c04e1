// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/manual/completion.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <string_view>

#include "common/config/key_description.h"
#include "launch/tools/manual/completion_shells.h"

namespace shoal::launch {
namespace {

// The words that fit at one place of a command line. Places are
//   "shoal env"                  a sub-command, or the first argument without a flag
//   "shoal env -"                an option
//   "shoal env render --quality" the value of an option, no words where any value fits
//   "= learner.algorithm"        the value of a configuration key
struct Row {
  std::string place;
  std::vector<Word> words;
};

void AddCommandRows(const CommandText& command, std::vector<Row>* rows) {
  Row first{command.name, {}}, options{command.name + " -", {}};
  for (const CommandText& below : command.commands) {
    first.words.push_back({below.name.substr(command.name.size() + 1), below.meaning});
  }
  for (const OptionText& option : command.options) {
    for (const std::string& flag : option.flags) {
      options.words.push_back({flag, option.meaning});
      if (option.takes_value) rows->push_back({command.name + " " + flag, option.values});
    }
    const bool argument = option.flags.empty();
    if (argument) first.words.insert(first.words.end(), option.values.begin(), option.values.end());
  }
  rows->push_back(first);
  rows->push_back(options);
}

std::vector<Row> AllRows(const std::vector<CommandText>& programs) {
  std::vector<Row> rows;
  for (const CommandText& program : programs) {
    for (const CommandText* command : AllCommands(program)) AddCommandRows(*command, &rows);
  }
  for (const KeyDescription& key : DescribeEachKey()) {
    Row row{"= " + std::string(key.path), {}};
    for (std::string_view word : key.words) row.words.push_back({std::string(word), ""});
    rows.push_back(row);
  }
  return rows;
}

// Quotes with single quotes, in which only the single quote (and in fish the backslash) is special.
std::string Quoted(Shell shell, std::string_view text) {
  std::string out = "'";
  for (char c : text) {
    if (c == '\'') {
      out += shell == Shell::kFish ? "\\'" : "'\\''";
    } else if (c == '\\' && shell == Shell::kFish) {
      out += "\\\\";
    } else {
      out += c;
    }
  }
  return out + "'";
}

// The first sentence only, because a list of words has one line for each word.
std::string FirstSentence(const std::string& meaning) {
  return meaning.substr(0, meaning.find(". "));
}

// Prints WORD, tab, MEANING for each word.
std::string PrintWords(Shell shell, const std::vector<Word>& words) {
  if (words.empty()) return "true";
  std::string text = "printf '%s\\t%s\\n'";
  for (const Word& word : words) {
    text += fmt::format(" \\\n      {} {}", Quoted(shell, word.word),
                        Quoted(shell, FirstSentence(word.meaning)));
  }
  return text;
}

// Prints the words of place $1; fails if there is no such place.
std::string Table(Shell shell, const std::vector<Row>& rows) {
  const bool fish = shell == Shell::kFish;
  std::string text =
      fish ? "function __shoal_table\n  switch $argv[1]\n" : "_shoal_table() {\n  case $1 in\n";
  for (const Row& row : rows) {
    const std::string place = Quoted(shell, row.place), print = PrintWords(shell, row.words);
    text += fish ? fmt::format("    case {}\n      {}\n", place, print)
                 : fmt::format("    {})\n      {}\n      ;;\n", place, print);
  }
  text += fish ? "    case '*'\n      return 1\n  end\nend\n"
               : "    *)\n      return 1\n      ;;\n  esac\n}\n";
  return text;
}

// The names of a program's sub-commands, as alternatives of a `case`.
std::string Levels(Shell shell, const std::vector<CommandText>& programs) {
  std::vector<std::string> levels;
  for (const CommandText& program : programs) {
    for (const CommandText* command : AllCommands(program)) {
      if (command != &program) levels.push_back(Quoted(shell, command->name));
    }
  }
  return fmt::format("{}", fmt::join(levels, shell == Shell::kFish ? " " : " | "));
}

std::string Replaced(std::string text, const std::string& mark, const std::string& by) {
  const size_t at = text.find(mark);
  return at == std::string::npos ? text : text.replace(at, mark.size(), by);
}

}  // namespace

std::string CompletionScript(Shell shell, const std::vector<CommandText>& programs) {
  const char* const script = shell == Shell::kBash  ? kBashCompletion
                             : shell == Shell::kZsh ? kZshCompletion
                                                    : kFishCompletion;
  std::vector<std::string> names;
  names.reserve(programs.size());
  for (const CommandText& program : programs) names.push_back(program.name);
  const std::string with_table = Replaced(script, "@TABLE@", Table(shell, AllRows(programs)));
  return Replaced(Replaced(with_table, "@LEVELS@", Levels(shell, programs)), "@PROGRAMS@",
                  fmt::format("{}", fmt::join(names, " ")));
}

}  // namespace shoal::launch
