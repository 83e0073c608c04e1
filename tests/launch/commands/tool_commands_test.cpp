// SPDX-License-Identifier: Apache-2.0
#include "launch/commands/tool_commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

namespace shoal::launch {
namespace {

using Words = std::vector<std::string>;

// The words of each sub-command below `app`, one or two.
std::vector<Words> CommandsOf(const CLI::App& app) {
  const auto all = [](const CLI::App*) { return true; };
  std::vector<Words> commands;
  for (const CLI::App* command : app.get_subcommands(all)) {
    if (command->get_name() != "env" && command->get_name() != "replay") {
      commands.push_back({command->get_name()});
      continue;
    }
    for (const CLI::App* inner : command->get_subcommands(all)) {
      commands.push_back({command->get_name(), inner->get_name()});
    }
  }
  return commands;
}

// A build without the tools refuses the commands of this list and no others.
TEST(ToolCommands, AreThoseOfTheList) {
  CLI::App app;
  app.add_subcommand("env");
  app.add_subcommand("replay");
  Action chosen;
  AddToolCommands(app, &chosen);
  EXPECT_THAT(CommandsOf(app), testing::UnorderedElementsAreArray(kToolCommands));
}

TEST(ToolCommands, NoneIsRefusedWhereTheToolsAreBuilt) {
  for (const Words& command : kToolCommands) EXPECT_NO_THROW(CheckToolsAreBuilt(command));
}

}  // namespace
}  // namespace shoal::launch
