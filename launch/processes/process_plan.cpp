// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/process_plan.h"

#include <algorithm>

#include "common/base/check.h"
#include "common/base/program_file.h"
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

namespace {

using link::Role;

ProcessSpec PlanProcess(const std::filesystem::path& run, const ProcessName& name,
                        const std::string& program, std::vector<std::string> arguments,
                        int threads) {
  arguments.insert(arguments.begin(), {"--run", run.string()});
  ProcessSpec spec = ProgramSpec(program, std::move(arguments), threads);
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
      return PlanProcess(run, name, "shoal-replay", {}, 1);
    case Role::kLearner:
      return PlanProcess(run, name, "shoal-learner", {}, config.learner.threads);
    case Role::kActor: {
      const int id = static_cast<int>(child.index);
      return child.host == 0 ? ActorProcess(run, id)
                             : RemoteActor(hosts.at(child.host - 1), id, run);
    }
    case Role::kEval:
      return PlanProcess(run, name, "shoal-actor", {"--role", "eval"}, 1);
    case Role::kCoordinator:
    case Role::kClient:
      break;
  }
  CHECK(false) << name.Text() << " is no child of the coordinator";
  return {};
}

}  // namespace

ProcessSpec ActorProcess(const std::filesystem::path& run, int id) {
  ProcessSpec spec = PlanProcess(run, ProcessName::Actor(static_cast<uint32_t>(id)), "shoal-actor",
                                 {"--id", std::to_string(id)}, 1);
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
    // A run in lockstep repeats bit for bit: it does not go on without one of its processes.
    const bool acts = child.role == Role::kActor || child.role == Role::kEval;
    spec.expendable = acts && !config.lockstep;
  }
  return plan;
}

}  // namespace shoal::launch
