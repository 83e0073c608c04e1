// SPDX-License-Identifier: Apache-2.0
// shoal-learner: the learner process of a run.
#include <CLI/CLI.hpp>

#include "common/base/command_line.h"
#include "common/base/log.h"
#include "common/base/main_guard.h"
#include "common/base/stop.h"
#include "common/base/usable_cores.h"
#include "common/config/learner_threads.h"
#include "common/config/run_files.h"
#include "common/config/run_membership.h"
#include "common/dds/bus.h"
#include "common/link/run_topology.h"
#include "common/tasks/environment_description.h"
#include "common/tasks/task_library.h"
#include "learner/command_line.h"
#include "learner/learner_program.h"
#include "learner/node_affinity.h"
#include "learner/openmp_environment.h"

namespace {

int Run(int argc, char** argv) {
  shoal::learner::Options options;
  const auto app = shoal::learner::MakeCommandLine(&options);
  if (const auto exit_code = shoal::ParseCommandLine(app.get(), argc, argv)) return *exit_code;
  shoal::InstallStopSignals();
  shoal::KeepSecuredRunPrivate(options.run);
  const shoal::RunConfig run = shoal::ReadRunConfig(options.run);
  const shoal::ProcessName name = shoal::link::RunTopology(run.config).OnlyLearner().Name();
  shoal::log::Start(name.Text(), "");
  shoal::tasks::LoadTaskLibrary(run.config.task_library);
  shoal::tasks::AddEnvironmentTask(run.spec.environment);
  const int threads = shoal::LearnerThreads(run.config, shoal::UsableCores());
  shoal::learner::EnsurePassiveOpenMp(threads, argv);
  const shoal::RunMembership member(options.run);
  shoal::dds::Bus bus(shoal::dds::FindEndpoint(options.run, run.config.transport, options.endpoint),
                      shoal::dds::Role::kLearner);
  shoal::learner::NodeAffinity affinity;
  return shoal::learner::LearnerProgram(options.run, name, run, threads, bus,
                                        shoal::learner::MakeAgent, &affinity)
      .Run();
}

}  // namespace

int main(int argc, char** argv) {
  shoal::dds::TuneMalloc();
  return shoal::GuardMain("shoal-learner", [&] { return Run(argc, argv); });
}
