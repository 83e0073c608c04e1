// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/process_plan.h"

#include <algorithm>

#include "common/base/check.h"
#include "common/base/program_file.h"
#include "common/tasks/environment_description.h"
#include "common/wire/process_name.h"
#include "launch/record/run_folder.h"

namespace shoal::launch {

std::filesystem::path ProgramFolder() { return ProgramFile().parent_path(); }

ProcessSpec ProgramSpec(const std::string& program, std::vector<std::string> arguments,
                        int threads) {
  ProcessSpec spec;
  spec.command = {(ProgramFolder() / program).string()};
  std::ranges::move(arguments, std::back_inserter(spec.command));
  spec.environment = {{"OMP_NUM_THREADS", std::to_string(threads)},
                      {"OMP_WAIT_POLICY", "passive"},
                      {"LP_NUM_THREADS", "0"}};
  return spec;
}

ProcessSpec ActorSpec(const Config& config, std::vector<std::string> arguments) {
  ProcessSpec spec = ProgramSpec("shoal-actor", std::move(arguments), 1);
  if (config.env.id.empty() || !tasks::LibraryOf(config.env.id).empty()) return spec;
  const std::vector<std::string> python{config.env.python, "-m", "shoal_rl.actor"};
  spec.command.erase(spec.command.begin());
  spec.command.insert(spec.command.begin(), python.begin(), python.end());
  // Unbuffered, so that the log contains the lines that were printed before a crash.
  spec.environment.emplace_back("PYTHONUNBUFFERED", "1");
  return spec;
}

namespace {

using link::Role;

ProcessSpec AsProcessOfRun(ProcessSpec spec, const std::filesystem::path& run,
                           const ProcessName& name) {
  spec.role = name.role;
  spec.id = static_cast<int>(name.index);
  spec.output = LogFile(run, spec.Name());
  return spec;
}

ProcessSpec PlanChild(const link::RunProcess& child, const Config& config,
                      const std::filesystem::path& run, const std::vector<RemoteHost>& hosts) {
  const ProcessName name = child.Name();
  switch (child.role) {
    case Role::kReplay:
      return AsProcessOfRun(ProgramSpec("shoal-replay", {"--run", run.string()}, 1), run, name);
    case Role::kLearner:
      return AsProcessOfRun(
          ProgramSpec("shoal-learner", {"--run", run.string()}, config.learner.threads), run, name);
    case Role::kActor: {
      const int id = static_cast<int>(child.index);
      return child.host == 0 ? ActorProcess(config, run, id)
                             : RemoteActor(hosts.at(child.host - 1), id, run);
    }
    case Role::kEval:
      return AsProcessOfRun(ActorSpec(config, {"--run", run.string(), "--role", "eval"}), run,
                            name);
    case Role::kCoordinator:
    case Role::kClient:
      break;
  }
  CHECK(false) << name.Text() << " is no child of the coordinator";
  return {};
}

}  // namespace

ProcessSpec ActorProcess(const Config& config, const std::filesystem::path& run, int id) {
  ProcessSpec spec =
      AsProcessOfRun(ActorSpec(config, {"--run", run.string(), "--id", std::to_string(id)}), run,
                     ProcessName::Actor(static_cast<uint32_t>(id)));
  spec.expendable = true;
  return spec;
}

link::RunTopology TopologyOf(const Config& config, const std::vector<RemoteHost>& hosts) {
  std::vector<int> actors;
  for (const RemoteHost& host : hosts) actors.push_back(host.actors);
  return link::RunTopology(config, actors);
}

ActorRange ActorsOf(const Config& config, const std::vector<RemoteHost>& hosts, size_t index) {
  const auto actors = TopologyOf(config, hosts).ActorsOn(static_cast<uint32_t>(index + 1));
  return {.first = static_cast<int>(actors.front().index),
          .count = static_cast<int>(actors.size())};
}

std::vector<ProcessSpec> PlanProcesses(const link::RunTopology& topology, const Config& config,
                                       const std::filesystem::path& run,
                                       const std::vector<RemoteHost>& hosts) {
  const std::vector<link::RunProcess> receivers = topology.RecordReceivers();
  std::vector<ProcessSpec> plan;
  for (const link::RunProcess& child : topology.children()) {
    ProcessSpec& spec = plan.emplace_back(PlanChild(child, config, run, hosts));
    // If the coordinator is killed, the receivers go on acknowledging the last records of the
    // actors. They exit once the heartbeat has been missing and no more records arrive.
    spec.outlives_parent = std::ranges::find(receivers, child) != receivers.end();
    // A lockstep run repeats bit for bit, so it cannot continue without one of its processes.
    const bool acts = child.role == Role::kActor || child.role == Role::kEval;
    spec.expendable = acts && !config.lockstep;
  }
  return plan;
}

}  // namespace shoal::launch
