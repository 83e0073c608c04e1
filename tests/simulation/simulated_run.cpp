// SPDX-License-Identifier: Apache-2.0
#include "tests/simulation/simulated_run.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

#include "actor/evaluation/eval_actor.h"
#include "actor/loop/training_actor.h"
#include "actor/worlds/environment.h"
#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/descriptor.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/random.h"
#include "common/base/sleep.h"
#include "common/config/run_files.h"
#include "common/link/local_network.h"
#include "common/run_folder/run_file_names.h"
#include "launch/processes/process_plan.h"
#include "launch/record/run_folder.h"
#include "launch/run/coordinator.h"
#include "launch/run/run_account.h"
#include "launch/run/run_server.h"
#include "launch/run/train_options.h"
#include "learner/agent/algorithms.h"
#include "learner/learner_program.h"
#include "replay_server/service/replay_service.h"
#include "tests/simulation/fake_environment.h"
#include "tests/simulation/fiber_scheduler.h"
#include "tests/simulation/hash_agent.h"
#include "tests/simulation/simulated_processes.h"

namespace shoal::simulation {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int64_t kWallTimeNs = 1'700'000'000'000'000'000;
constexpr microseconds kStep{20'000};
constexpr microseconds kUpdate{30'000};
// A run that has not ended by then never will: it lasts 20 s without faults.
constexpr seconds kPatience{600};

// The coordinator shows its progress on standard output: its log has the same lines.
class SilentOutput {
 public:
  SilentOutput() : kept_((std::fflush(stdout), dup(STDOUT_FILENO))) {
    const Descriptor nothing(open("/dev/null", O_WRONLY | O_CLOEXEC));
    CHECK(dup2(nothing.get(), STDOUT_FILENO) == STDOUT_FILENO);
  }
  ~SilentOutput() {
    std::fflush(stdout);
    dup2(kept_.get(), STDOUT_FILENO);
  }
  SilentOutput(const SilentOutput&) = delete;
  SilentOutput& operator=(const SilentOutput&) = delete;

 private:
  const Descriptor kept_;
};

int RunBody(const Blueprint& blueprint, const std::filesystem::path& folder,
            const launch::ProcessSpec& spec, link::Hub& hub) {
  const link::RunProcess process{.role = *link::FindRole(spec.role),
                                 .index = static_cast<uint32_t>(spec.id)};
  const auto make_agent = [&](const Config&, const ObservationSpec&, nn::Precision) {
    return std::make_unique<HashAgent>(blueprint.policy, kUpdate);
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

// The coordinator's part, as `shoal train` puts it together.
launch::RunResult Coordinate(const Blueprint& blueprint, const std::filesystem::path& folder,
                             link::Hub& hub, SimulatedProcesses& processes) {
  const Config& config = blueprint.run.config;
  launch::RunServer desk(hub, config.run_name);
  launch::Progress progress(launch::LogFile(folder, "coordinator").string(), nullptr,
                            /*plain=*/true);
  launch::RunMeta meta;
  meta.started = UtcTimestamp();
  launch::Coordinator coordinator(
      {.run = folder,
       .config = config,
       .before = meta,
       .hosts = {},
       .hub = hub,
       .desk = desk,
       .progress = progress,
       .start = [&](const launch::ProcessSpec& spec) { return processes.Start(spec); }});
  return coordinator.Run(nullptr);
}

void Apply(const Fault& fault, SimulatedProcesses& processes) {
  if (fault.kind == Fault::Kind::kKill) {
    processes.Kill(fault.process);
  } else {
    processes.Pause(fault.process, fault.span);
  }
}

// Holds the files of a run against what it promises.
void Judge(const Blueprint& blueprint, const std::filesystem::path& folder,
           const launch::RunResult& result, Outcome* outcome) {
  const Config& config = blueprint.run.config;
  auto& violations = outcome->violations;
  outcome->exit = result.meta.exit;
  if (result.meta.exit != "budget") {
    violations.push_back(
        fmt::format("the run ended as {}: {}", result.meta.exit, result.meta.error));
  }
  // A kill while the run stops is no restart any more: the run says so, and that it was unclean.
  const bool killed = outcome->log.find("killed by SIGKILL while stopping") != std::string::npos;
  if (result.clean == killed) violations.emplace_back("a process did not leave in order");
  if (!result.unwritten.empty()) violations.emplace_back("something was not written");
  const auto account =
      launch::AccountRun(folder, config, launch::TopologyOf(config, {}), result.meta.resends);
  if (!account) {
    violations.emplace_back("there is no account");
    return;
  }
  for (const std::string& fault : account->faults) violations.push_back("account: " + fault);
  if (account->stored < static_cast<uint64_t>(config.env_steps)) {
    violations.push_back(fmt::format("{} records stored of a budget of {} steps", account->stored,
                                     config.env_steps));
  }
}

}  // namespace

Blueprint MakeBlueprint() {
  launch::TrainOptions options;
  options.preset = "fetch-reach-state";
  options.run_name = "run";
  options.set = {"env_steps=400",
                 "actors=2",
                 "envs_per_actor=2",
                 "learner.threads=1",
                 "learner.batch=4",
                 "replay.capacity=1000",
                 "replay.min_size=50",
                 "replay.samples_per_insert=4",
                 "network.hidden=[8,8]",
                 "eval.interval=100",
                 "eval.episodes=2",
                 "eval.final_episodes=0",
                 "learner.checkpoint_period=2",
                 "stop.success=2"};
  Blueprint blueprint{.run = {launch::ResolveConfig(options, 1), {}}, .policy = {}};
  blueprint.run.spec = worlds::MakeEnvironment(blueprint.run.config, nullptr)->spec();
  blueprint.policy =
      learner::MakeAgent(blueprint.run.config, blueprint.run.spec, nn::Precision::kF32)
          ->PolicyTensors();
  return blueprint;
}

std::string Fault::Text() const {
  const double from = static_cast<double>(at.count()) / 1000;
  if (kind == Kind::kKill) return fmt::format("{:.3f} s: kill {}", from, process);
  return fmt::format("{:.3f} s: pause {} for {:.3f} s", from, process,
                     static_cast<double>(span.count()) / 1000);
}

std::vector<Fault> DrawFaults(uint64_t seed, const Config& config) {
  Random random(HashWords({seed, 1}));
  std::vector<std::string> names{"replay-0", "learner-0", "eval-0"};
  for (int i = 0; i < config.actors; ++i) names.push_back(fmt::format("actor-{}", i));
  std::vector<Fault> faults(random.Below(5));
  for (Fault& fault : faults) {
    fault.kind = random.Uniform() < 0.6 ? Fault::Kind::kKill : Fault::Kind::kPause;
    fault.at = milliseconds(random.Below(30'000));
    fault.process = names[random.Below(names.size())];
    fault.span = milliseconds(static_cast<int64_t>(100 * std::pow(600, random.Uniform())));
  }
  std::ranges::sort(faults, {}, &Fault::at);
  return faults;
}

Outcome Simulate(const Blueprint& blueprint, uint64_t seed, const std::vector<Fault>& faults,
                 const std::filesystem::path& folder) {
  const auto held = launch::RunFolder::Create(folder.parent_path(), folder.filename().string(),
                                              /*overwrite=*/false);
  WriteRunConfig(folder, blueprint.run);
  FiberScheduler scheduler(seed, kWallTimeNs);
  // A run that does not end leaves hubs, which may not outlive their network: it is never
  // destroyed.
  auto& network = *new link::LocalNetwork();  // NOLINT: ends with this process, as killed ones do
  ThreadGroup coordinator("coordinator", (folder / kLogFolder / "train.log").string());
  ThreadGroup faulter("faults", (folder / kLogFolder / "faults.log").string());
  SimulatedProcesses processes(scheduler, network,
                               [&](const launch::ProcessSpec& spec, link::Hub& hub) {
                                 return RunBody(blueprint, folder, spec, hub);
                               });
  std::optional<launch::RunResult> result;
  std::string failure;
  scheduler.StartIn(&coordinator, [&] {
    const auto hub = network.Join(link::Role::kCoordinator);
    try {
      result = Coordinate(blueprint, folder, *hub, processes);
    } catch (const Error& error) {
      failure = error.what();
    }
  });
  scheduler.StartIn(&faulter, [&] {
    const SteadyTime start = Now();
    for (const Fault& fault : faults) {
      SleepUntil(start + fault.at);
      if (!result && failure.empty()) Apply(fault, processes);
    }
  });
  const SteadyTime end = SteadyTime() + kPatience;
  const SilentOutput silent;
  while (scheduler.Alive(&coordinator) > 0 && scheduler.NowOutside() < end) {
    scheduler.RunUntil(scheduler.NowOutside() + seconds(1));
  }
  Outcome outcome;
  outcome.log = ReadFile(launch::LogFile(folder, "coordinator"));
  outcome.seconds =
      std::chrono::duration<double>(scheduler.NowOutside().time_since_epoch()).count();
  outcome.trace = scheduler.TraceHash();
  outcome.switches = scheduler.switches();
  if (!failure.empty()) {
    outcome.violations.push_back("the coordinator failed: " + failure);
  } else if (!result) {
    outcome.violations.push_back(
        fmt::format("the run has not ended after {} simulated seconds", kPatience.count()));
  } else {
    Judge(blueprint, folder, *result, &outcome);
  }
  return outcome;
}

}  // namespace shoal::simulation
