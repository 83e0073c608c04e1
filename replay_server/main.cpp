// SPDX-License-Identifier: Apache-2.0
// shoal-replay: the replay server of a run.
#include <CLI/CLI.hpp>

#include "common/base/command_line.h"
#include "common/base/log.h"
#include "common/base/main_guard.h"
#include "common/base/stop.h"
#include "common/config/run_files.h"
#include "common/dds/bus.h"
#include "common/tasks/task_library.h"
#include "common/wire/process_name.h"
#include "replay_server/service/command_line.h"
#include "replay_server/service/replay_service.h"

namespace {

int Run(int argc, char** argv) {
  shoal::replay::Options options;
  const auto app = shoal::replay::MakeCommandLine(&options);
  if (const auto exit_code = shoal::ParseCommandLine(app.get(), argc, argv)) return *exit_code;
  shoal::InstallStopSignals();
  shoal::log::Start(shoal::ProcessName::Replay(0).Text(), "");
  shoal::tasks::LoadTaskLibrary(shoal::ReadRunConfig(options.run).config.task_library);
  return shoal::replay::RunReplayService(options.run, options.reach);
}

}  // namespace

int main(int argc, char** argv) {
  shoal::dds::TuneMalloc();
  return shoal::GuardMain("shoal-replay", [&] { return Run(argc, argv); });
}
