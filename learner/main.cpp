// shoal-learner: the learner process of a run.
#include <CLI/CLI.hpp>

#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/main_guard.h"
#include "common/base/stop.h"
#include "common/config/run_files.h"
#include "common/dds/bus.h"
#include "common/tasks/task_library.h"
#include "learner/command_line.h"
#include "learner/learner_program.h"

namespace {

int Run(int argc, char** argv) {
  shoal::learner::Options options;
  const auto app = shoal::learner::MakeCommandLine(&options);
  try {
    app->parse(argc, argv);
  } catch (const CLI::Success& e) {
    return app->exit(e);
  } catch (const CLI::ParseError& e) {
    throw shoal::UsageError("{}", e.what());
  }
  shoal::log::Start("learner-0", "");
  shoal::InstallStopSignals();
  shoal::tasks::LoadTaskLibrary(shoal::ReadRunConfig(options.run).config.task_library);
  return shoal::learner::RunLearner(options.run, options.reach, argv);
}

}  // namespace

int main(int argc, char** argv) {
  shoal::dds::TuneMalloc();
  return shoal::GuardMain("shoal-learner", [&] { return Run(argc, argv); });
}
