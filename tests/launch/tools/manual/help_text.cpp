// SPDX-License-Identifier: Apache-2.0
#include "tests/launch/tools/manual/help_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>
#include <sstream>

#include "tests/support/paths.h"
#include "tests/support/program.h"

namespace shoal {
namespace {

HelpText ReadHelp(std::vector<std::string> words) {
  HelpText help{.words = words, .description = "", .flags = {}, .arguments = {}, .commands = {}};
  words.push_back("--help");
  const ProgramResult result = RunProgram(words, std::chrono::seconds(60));
  EXPECT_EQ(ExitCode(result), 0) << result.err;
  std::istringstream lines(result.out);
  std::getline(lines, help.description);
  std::string section;
  const std::regex entry("^  ([^ ]+)( .*)?$");
  std::smatch match;
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with(':') && !line.starts_with(' ')) section = line;
    if (!std::regex_match(line, match, entry)) continue;
    const std::string name = match[1];
    if (section == "Subcommands:") help.commands.insert(name);
    if (section == "Positionals:") help.arguments.insert(name);
    if (section != "Options:") continue;
    std::istringstream flags(name);
    for (std::string flag; std::getline(flags, flag, ',');) help.flags.insert(flag);
  }
  EXPECT_THAT(help.flags, testing::Contains("--help")) << result.out;
  return help;
}

void Collect(const std::vector<std::string>& words, std::vector<HelpText>* all) {
  all->push_back(ReadHelp(words));
  for (const std::string& command : std::set<std::string>(all->back().commands)) {
    std::vector<std::string> below = words;
    below.push_back(command);
    Collect(below, all);
  }
}

}  // namespace

std::string HelpText::name() const {
  std::string name;
  for (const std::string& word : words) name += (name.empty() ? "" : " ") + word;
  return name;
}

const std::vector<HelpText>& AllHelp() {
  static const std::vector<HelpText> all = [] {
    std::vector<HelpText> found;
    for (const char* program : {"shoal", "shoal-actor", "shoal-learner", "shoal-replay"}) {
      Collect({program}, &found);
    }
    return found;
  }();
  return all;
}

std::string SharePath(const std::string& file) {
  return std::filesystem::path(ProgramPath("shoal")).parent_path().parent_path() / "share" / file;
}

}  // namespace shoal
