// SPDX-License-Identifier: Apache-2.0
// shoal-manual FOLDER: writes manual pages, completions and the configuration's schema. Part of the
// build, not installed.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "actor/command_line.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/main_guard.h"
#include "common/config/config_schema.h"
#include "launch/commands/command_line.h"
#include "launch/tools/manual/completion.h"
#include "launch/tools/manual/man_page.h"
#include "learner/command_line.h"
#include "replay_server/service/command_line.h"

namespace {

namespace fs = std::filesystem;
using shoal::launch::CommandText;
using shoal::launch::Shell;

void Write(const fs::path& file, const std::string& text) {
  shoal::MakeFolders(file.parent_path());
  shoal::WriteFileForOthers(file, text);
}

std::vector<CommandText> Programs() {
  shoal::launch::Action chosen;
  shoal::actor::Options actor;
  shoal::learner::Options learner;
  shoal::replay::Options replay;
  const auto describe = [](const CLI::App& app) {
    return shoal::launch::DescribeCommand(app, app.get_name());
  };
  return {describe(*shoal::launch::MakeCommandLine(&chosen)),
          describe(*shoal::actor::MakeCommandLine(&actor)),
          describe(*shoal::learner::MakeCommandLine(&learner)),
          describe(*shoal::replay::MakeCommandLine(&replay))};
}

int Run(int argc, char** argv) {
  if (argc != 2) throw shoal::UsageError("usage: shoal-manual FOLDER");
  const fs::path folder = argv[1];
  const std::vector<CommandText> programs = Programs();
  for (const CommandText& program : programs) {
    const bool whole = !program.commands.empty();
    Write(folder / "man/man1" / (program.name + ".1"),
          ProgramPage(program, whole ? "shoal-configuration(5), shoal-actor(1), shoal-learner(1), "
                                       "shoal-replay(1)"
                                     : "shoal(1)"));
  }
  Write(folder / "man/man5/shoal-configuration.5", shoal::launch::ConfigurationPage());
  Write(folder / "bash-completion/completions/shoal", CompletionScript(Shell::kBash, programs));
  Write(folder / "zsh/vendor-completions/_shoal", CompletionScript(Shell::kZsh, programs));
  Write(folder / "fish/vendor_completions.d/shoal.fish", CompletionScript(Shell::kFish, programs));
  Write(folder / "shoal/config.schema.json", shoal::ConfigSchema().dump(2) + "\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return shoal::GuardMain("shoal-manual", [&] { return Run(argc, argv); });
}
