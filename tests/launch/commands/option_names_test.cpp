// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "launch/commands/command_line.h"

namespace shoal::launch {
namespace {

// Names that two options of a command have, as "COMMAND: NAME". Arguments without dashes count too:
// CLI11 2.4 refuses such names when the program starts, CLI11 2.3 accepts them.
void FindEqualNames(const CLI::App& command, std::vector<std::string>* found) {
  std::map<std::string, int> times;
  for (const CLI::Option* option : command.get_options()) {
    std::set<std::string> names(option->get_lnames().begin(), option->get_lnames().end());
    if (option->get_positional()) names.insert(option->get_name(/*positional=*/true));
    for (const std::string& name : names) ++times[name];
  }
  for (const auto& [name, count] : times) {
    if (count > 1) found->push_back(command.get_name() + ": " + name);
  }
  for (const CLI::App* below : command.get_subcommands([](const CLI::App*) { return true; })) {
    FindEqualNames(*below, found);
  }
}

TEST(OptionNames, NoTwoOfACommandAreEqual) {
  Action chosen;
  std::vector<std::string> found;
  FindEqualNames(*MakeCommandLine(&chosen), &found);
  EXPECT_THAT(found, testing::IsEmpty());
}

}  // namespace
}  // namespace shoal::launch
