// SPDX-License-Identifier: Apache-2.0
// shoal: the command line. See launch/commands.
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "common/base/command_line.h"
#include "common/base/error.h"
#include "common/base/main_guard.h"
#include "common/base/nearest_name.h"
#include "common/dds/bus.h"
#include "launch/commands/command_line.h"

namespace {

// Asked first: what is said of its options would be of no use.
void CheckCommand(const CLI::App& app, int argc, char** argv) {
  const CLI::App* level = &app;
  for (int i = 1; i < argc && argv[i][0] != '-'; ++i) {
    std::vector<std::string> names;
    const CLI::App* named = nullptr;
    for (const CLI::App* command : level->get_subcommands([](const CLI::App*) { return true; })) {
      names.push_back(command->get_name());
      if (names.back() == argv[i]) named = command;
    }
    if (names.empty()) return;
    if (named == nullptr) {
      throw shoal::UsageError("unknown command '{}' (see {} --help){}", argv[i], level->get_name(),
                              shoal::NearestHint(argv[i], names));
    }
    level = named;
  }
}

int Run(int argc, char** argv) {
  shoal::launch::Action chosen;
  const auto app = shoal::launch::MakeCommandLine(&chosen);
  CheckCommand(*app, argc, argv);
  if (const auto exit_code = shoal::ParseCommandLine(app.get(), argc, argv)) return *exit_code;
  return chosen();
}

}  // namespace

int main(int argc, char** argv) {
  shoal::dds::TuneMalloc();
  return shoal::GuardMain("shoal", [&] { return Run(argc, argv); });
}
