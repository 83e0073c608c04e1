// SPDX-License-Identifier: Apache-2.0
#include "launch/commands/command_line.h"

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "common/base/command_line.h"
#include "common/base/error.h"
#include "launch/commands/other_words.h"
#include "launch/commands/tool_commands.h"

namespace shoal::launch {
namespace {

// Checked before options, so that the error names the unknown command and not an option.
void CheckCommand(const CLI::App& app, const std::vector<std::string>& words) {
  const CLI::App* level = &app;
  std::string before;  // names of the parent commands
  for (const std::string& word : words) {
    if (word.starts_with('-')) return;
    std::vector<std::string> names;
    const CLI::App* named = nullptr;
    for (const CLI::App* command : level->get_subcommands([](const CLI::App*) { return true; })) {
      names.push_back(command->get_name());
      if (names.back() == word) named = command;
    }
    if (names.empty()) return;
    if (named == nullptr) {
      throw UsageError("unknown command '{}' (see {}{} --help){}", word, before, level->get_name(),
                       HintForCommand(word, names));
    }
    before += level->get_name() + " ";
    level = named;
  }
}

}  // namespace

std::unique_ptr<CLI::App> MakeCommandLine(Action* chosen) {
  auto app = std::make_unique<CLI::App>(
      "Shoal trains robot policies from pixels and from state, on many processes.", "shoal");
  AddVersion(app.get());
  app->require_subcommand(1);
  AddTrainCommand(*app, chosen);
  AddEvalCommand(*app, chosen);
  AddTopCommand(*app, chosen);
  AddRunsCommand(*app, chosen);
  AddCleanCommand(*app, chosen);
  AddSteerCommands(*app, chosen);
  AddAttachCommand(*app, chosen);
  AddEnvCommand(*app, chosen);
  AddReplayCommand(*app, chosen);
  AddConfigCommand(*app, chosen);
  AddCheckCommand(*app, chosen);
  AddSecureCommand(*app, chosen);
  AddToolCommands(*app, chosen);
  return app;
}

int RunCommandLine(int argc, char** argv) {
  Action chosen;
  const auto app = MakeCommandLine(&chosen);
  std::vector<std::string> words(argv + 1, argv + argc);
  CheckToolsAreBuilt(words);
  CheckCommand(*app, words);
  words = AsCommandsTakeThem(*app, std::move(words));
  if (const auto exit_code = ParseCommandLine(app.get(), words, HintForWord)) return *exit_code;
  return chosen();
}

}  // namespace shoal::launch
