// shoal-replay: the replay server of a run.
#include <CLI/CLI.hpp>
#include <string>

#include "common/base/build_info.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/main_guard.h"
#include "common/base/stop.h"
#include "common/config/run_files.h"
#include "common/dds/bus.h"
#include "common/tasks/task_library.h"
#include "replay_server/service/replay_service.h"

namespace {

int Run(int argc, char** argv) {
  std::string folder;
  shoal::dds::Reach reach;
  CLI::App app("Stores transitions and hands out batches for one run.", "shoal-replay");
  app.set_version_flag("--version", shoal::BuildVersion());
  app.add_option("--run", folder, "folder of the run")->required();
  app.add_option("--peer", reach.peer, "HOST[:PORT] of the servers instead of cluster.json's");
  app.add_option("--interface", reach.interface,
                 "network interface of this host instead of transport.interface");
  app.add_option("--secure", reach.secure,
                 "folder of credentials instead of cluster.json's (shoal secure init)");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    throw shoal::UsageError("{}", e.what());
  }
  shoal::InstallStopSignals();
  shoal::log::Start("replay-0", "");
  shoal::tasks::LoadTaskLibrary(shoal::ReadRunConfig(folder).config.task_library);
  return shoal::replay::RunReplayService(folder, reach);
}

}  // namespace

int main(int argc, char** argv) {
  shoal::dds::TuneMalloc();
  return shoal::GuardMain("shoal-replay", [&] { return Run(argc, argv); });
}
