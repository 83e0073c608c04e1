// shoal: the command line. See launch/commands.
#include <CLI/CLI.hpp>

#include "common/base/error.h"
#include "common/base/main_guard.h"
#include "common/dds/bus.h"
#include "launch/commands/command_line.h"

namespace {

// The first word that should be a command and is none; empty when there is no such word.
std::string UnknownCommand(const CLI::App& app, int argc, char** argv) {
  const CLI::App* level = &app;
  const auto any = [](const CLI::App*) { return true; };
  for (int i = 1; i < argc && argv[i][0] != '-' && !level->get_subcommands(any).empty(); ++i) {
    const auto named = level->get_subcommands(
        [&](const CLI::App* command) { return command->get_name() == argv[i]; });
    if (named.empty()) return argv[i];
    level = named[0];
  }
  return "";
}

int Run(int argc, char** argv) {
  shoal::launch::Action chosen;
  const auto command_line = shoal::launch::MakeCommandLine(&chosen);
  CLI::App& app = *command_line;
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {
    return app.exit(e);  // --help, --version
  } catch (const CLI::RequiredError& e) {
    const std::string unknown = UnknownCommand(app, argc, argv);
    if (!unknown.empty())
      throw shoal::UsageError("unknown command '{}' (see shoal --help)", unknown);
    throw shoal::UsageError("{} (see shoal --help)", e.what());
  } catch (const CLI::ParseError& e) {
    throw shoal::UsageError("{} (see shoal --help)", e.what());
  }
  return chosen();
}

}  // namespace

int main(int argc, char** argv) {
  shoal::dds::TuneMalloc();
  return shoal::GuardMain("shoal", [&] { return Run(argc, argv); });
}
