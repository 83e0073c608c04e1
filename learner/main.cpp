// SPDX-License-Identifier: Apache-2.0
// shoal-learner: the learner process of a run.
#include <CLI/CLI.hpp>

#include "common/base/command_line.h"
#include "common/base/log.h"
#include "common/base/main_guard.h"
#include "common/base/stop.h"
#include "common/config/run_files.h"
#include "common/dds/bus.h"
#include "common/tasks/task_library.h"
#include "common/wire/process_name.h"
#include "learner/command_line.h"
#include "learner/learner_program.h"

namespace {

int Run(int argc, char** argv) {
  shoal::learner::Options options;
  const auto app = shoal::learner::MakeCommandLine(&options);
  if (const auto exit_code = shoal::ParseCommandLine(app.get(), argc, argv)) return *exit_code;
  shoal::log::Start(shoal::ProcessName::Learner().Text(), "");
  shoal::InstallStopSignals();
  shoal::tasks::LoadTaskLibrary(shoal::ReadRunConfig(options.run).config.task_library);
  return shoal::learner::RunLearner(options.run, options.reach, argv);
}

}  // namespace

int main(int argc, char** argv) {
  shoal::dds::TuneMalloc();
  return shoal::GuardMain("shoal-learner", [&] { return Run(argc, argv); });
}
