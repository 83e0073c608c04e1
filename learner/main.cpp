// shoal-learner: the learner process of a run.
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
#include "learner/learner_program.h"

namespace {

int Run(int argc, char** argv) {
  std::string run;
  shoal::dds::Reach reach;
  CLI::App app("Trains the policy of a run on batches from its replay.");
  app.set_version_flag("--version", shoal::BuildVersion());
  app.add_option("--run", run, "run folder (config.json, cluster.json)")->required();
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
  shoal::log::Start("learner-0", "");
  shoal::InstallStopSignals();
  shoal::tasks::LoadTaskLibrary(shoal::ReadRunConfig(run).config.task_library);
  return shoal::learner::RunLearner(run, reach, argv);
}

}  // namespace

int main(int argc, char** argv) {
  shoal::dds::TuneMalloc();
  return shoal::GuardMain("shoal-learner", [&] { return Run(argc, argv); });
}
