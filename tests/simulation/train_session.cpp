// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/train_session.h"

#include <string>
#include <utility>

#include "actor/evaluation/eval_actor.h"
#include "actor/loop/training_actor.h"
#include "common/base/check.h"
#include "common/base/file_lock.h"
#include "common/config/run_files.h"
#include "common/run_folder/run_file_names.h"
#include "launch/processes/process_plan.h"
#include "launch/processes/run_leftovers.h"
#include "launch/record/run_folder.h"
#include "launch/run/resumed_run.h"
#include "launch/run/run_end.h"
#include "launch/run/run_request.h"
#include "launch/run/run_server.h"
#include "launch/run/train_options.h"
#include "learner/learner_program.h"
#include "replay_server/service/replay_service.h"
#include "tests/simulation/fake_environment.h"
#include "tests/simulation/hash_agent.h"

namespace shoal::simulation {
namespace {

launch::TrainOptions OptionsOf(const World& world, Begin begin) {
  launch::TrainOptions options;
  options.run_dir = world.folder.parent_path();
  options.overwrite = begin == Begin::kOverwrite;
  if (begin == Begin::kResume) options.resume = world.folder;
  return options;
}

launch::RunRequest Resolve(const World& world, const launch::TrainOptions& options) {
  if (!options.resume.empty()) {
    return launch::ResolveResumed(options, [&](const Config&) {
      return launch::ObservedWorld{.spec = world.blueprint.run.spec};
    });
  }
  launch::RunRequest request{.config = world.blueprint.run};
  request.config.config.run_dir = world.folder.parent_path();
  request.config.config.run_name = world.folder.filename();
  return request;
}

}  // namespace

int Train(const World& world, Begin begin, link::Hub& hub, std::optional<bool>* clean) {
  const launch::TrainOptions options = OptionsOf(world, begin);
  launch::RunRequest request = Resolve(world, options);
  const launch::RunFolder folder = launch::TakeFolder(options, &request);
  launch::WaitUntilUnused(folder.path());
  launch::RemoveUnfinishedFiles(folder.path());
  WriteRunConfig(folder.path(), request.config);
  WriteClusterAddress(folder.path(), {});
  const Config& config = request.config.config;
  launch::RunServer server(hub, config.run_name);
  launch::Progress progress(
      launch::LogFile(folder.path(), "coordinator").string(),
      [&](const std::string& line) {
        server.AddEvent(line);
        world.story.Add("coordinator", line);
      },
      /*plain=*/true);
  launch::RunResult result;
  {
    launch::Coordinator coordinator({.run = folder.path(),
                                     .config = config,
                                     .before = request.meta,
                                     .hosts = {},
                                     .hub = hub,
                                     .server = server,
                                     .progress = progress,
                                     .start = [&](const launch::ProcessSpec& spec) {
                                       return world.processes.StartChild(spec);
                                     }});
    result = coordinator.Run(nullptr);
  }
  *clean = result.clean;
  const int code = launch::EndRun(folder.path(), config, launch::TopologyOf(config, {}),
                                  std::move(result), /*film=*/false, server, progress);
  server.ShowEnd(code);
  return code;
}

void AskForRun(const World& world) { Resolve(world, OptionsOf(world, Begin::kResume)); }

int RunChild(const Blueprint& blueprint, const std::filesystem::path& folder, Story& story,
             const launch::ProcessSpec& spec, link::Hub& hub) {
  // In place of RunMembership, whose lock is that of a process of the operating system.
  const auto member = FileLock::Take(folder / kMembersFile, Holding::kWithOthers);
  CHECK(member) << "no process holds the file alone";
  const link::RunProcess process{.role = *link::FindRole(spec.role),
                                 .index = static_cast<uint32_t>(spec.id)};
  const auto make_agent = [&](const Config&, const ObservationSpec&, nn::Precision) {
    return std::make_unique<HashAgent>(blueprint.policy, kUpdate, story);
  };
  switch (process.role) {
    case link::Role::kActor:
      return actor::TrainingActor(folder, process.index, hub, FakeEnvironments(kStep)).Run();
    case link::Role::kEval:
      return actor::EvalActor(folder, hub, FakeEnvironments(kStep)).Run();
    case link::Role::kReplay:
      return replay::ReplayService(folder, process.Name(), hub).Run();
    case link::Role::kLearner:
      return learner::LearnerProgram(folder, process.Name(), ReadRunConfig(folder), /*threads=*/1,
                                     hub, make_agent)
          .Run();
    default:
      break;
  }
  CHECK(false) << spec.role;
  return 1;
}

}  // namespace shoal::simulation
