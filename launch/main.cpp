// shoal: the command line. See launch/commands.
#include <CLI/CLI.hpp>

#include "common/base/build_info.h"
#include "common/base/error.h"
#include "common/base/main_guard.h"
#include "common/dds/bus.h"
#include "launch/commands/commands.h"

namespace {

int Run(int argc, char** argv) {
  CLI::App app("Shoal trains robot policies from pixels with SAC and DrQ, on many processes.");
  app.set_version_flag("--version",
                       fmt::format("shoal {} ({})", shoal::BuildVersion(), shoal::BuildCommit()));
  app.require_subcommand(1);
  shoal::launch::Action chosen;
  shoal::launch::AddTrainCommand(app, &chosen);
  shoal::launch::AddEvalCommand(app, &chosen);
  shoal::launch::AddEnvCommand(app, &chosen);
  shoal::launch::AddReplayCommand(app, &chosen);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {
    return app.exit(e);  // --help, --version
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
