// SPDX-License-Identifier: Apache-2.0
// shoal-replay: the replay server of a run.
#include <CLI/CLI.hpp>

#include "common/base/command_line.h"
#include "common/base/error.h"
#include "common/base/log.h"
#include "common/base/main_guard.h"
#include "common/base/stop.h"
#include "common/config/run_files.h"
#include "common/config/run_membership.h"
#include "common/dds/bus.h"
#include "common/link/run_topology.h"
#include "common/tasks/environment_description.h"
#include "common/tasks/task_library.h"
#include "replay_server/service/command_line.h"
#include "replay_server/service/replay_service.h"

namespace {

int Run(int argc, char** argv) {
  shoal::replay::Options options;
  const auto app = shoal::replay::MakeCommandLine(&options);
  if (const auto exit_code = shoal::ParseCommandLine(app.get(), argc, argv)) return *exit_code;
  shoal::InstallStopSignals();
  shoal::KeepSecuredRunPrivate(options.run);
  const shoal::RunMembership member(options.run);
  const shoal::RunConfig run = shoal::ReadRunConfig(options.run);
  const shoal::Config& config = run.config;
  const shoal::link::RunTopology topology(config);
  if (!topology.Has(shoal::link::Role::kReplay)) {
    throw shoal::UsageError("run '{}' has no replay: learner.algorithm = {} learns from rollouts",
                            options.run, config.learner.algorithm);
  }
  const shoal::ProcessName name = topology.OnlyReplay().Name();
  shoal::log::Start(name.Text(), "");
  shoal::tasks::LoadTaskLibrary(config.task_library);
  shoal::tasks::AddEnvironmentTask(run.spec.environment);
  shoal::dds::Bus bus(shoal::dds::FindEndpoint(options.run, config.transport, options.endpoint),
                      shoal::dds::Role::kReplay);
  return shoal::replay::ReplayService(options.run, name, bus).Run();
}

}  // namespace

int main(int argc, char** argv) {
  shoal::dds::TuneMalloc();
  return shoal::GuardMain("shoal-replay", [&] { return Run(argc, argv); });
}
