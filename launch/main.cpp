// shoal: the command line. See launch/commands.
#include <CLI/CLI.hpp>

#include "common/base/build_info.h"
#include "common/base/error.h"
#include "common/base/main_guard.h"
#include "common/dds/bus.h"
#include "launch/commands/commands.h"

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
  CLI::App app("Shoal trains robot policies from pixels and from state, on many processes.",
               "shoal");
  app.set_version_flag("--version",
                       fmt::format("shoal {} ({})", shoal::BuildVersion(), shoal::BuildCommit()));
  app.require_subcommand(1);
  shoal::launch::Action chosen;
  shoal::launch::AddTrainCommand(app, &chosen);
  shoal::launch::AddEvalCommand(app, &chosen);
  shoal::launch::AddExperimentCommand(app, &chosen);
  shoal::launch::AddCompareCommand(app, &chosen);
  shoal::launch::AddPlotCommand(app, &chosen);
  shoal::launch::AddReportCommand(app, &chosen);
  shoal::launch::AddCardCommand(app, &chosen);
  shoal::launch::AddFilmCommand(app, &chosen);
  shoal::launch::AddTopCommand(app, &chosen);
  shoal::launch::AddRunsCommand(app, &chosen);
  shoal::launch::AddWebCommand(app, &chosen);
  shoal::launch::AddSteerCommands(app, &chosen);
  shoal::launch::AddAttachCommand(app, &chosen);
  shoal::launch::AddEnvCommand(app, &chosen);
  shoal::launch::AddReplayCommand(app, &chosen);
  shoal::launch::AddCheckCommand(app, &chosen);
  shoal::launch::AddSecureCommand(app, &chosen);
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
