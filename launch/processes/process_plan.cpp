// SPDX-License-Identifier: Apache-2.0
#include "launch/processes/process_plan.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/config/on_policy.h"
#include "common/wire/process_name.h"
#include "launch/record/run_folder.h"

namespace shoal::launch {

std::filesystem::path ProgramFolder() {
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) throw RuntimeError("cannot read /proc/self/exe: {}", error.message());
  return program.parent_path();
}

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

}  // namespace

ProcessSpec ActorProcess(const std::filesystem::path& run, int id) {
  ProcessSpec spec = PlanProcess(run, ProcessName::Actor(static_cast<uint32_t>(id)), "shoal-actor",
                                 {"--id", std::to_string(id)}, 1);
  spec.expendable = true;
  return spec;
}

ActorRange ActorsOf(const Config& config, const std::vector<RemoteHost>& hosts, size_t index) {
  int first = config.actors;
  for (size_t i = index; i < hosts.size(); ++i) first -= hosts[i].actors;
  return {.first = first, .count = hosts[index].actors};
}

std::vector<ProcessSpec> PlanProcesses(const Config& config, const std::filesystem::path& run,
                                       const std::vector<RemoteHost>& hosts) {
  std::vector<ProcessSpec> plan;
  const bool on_policy = LearnsOnPolicy(config);
  // When the coordinator is killed, the actors' last records want somebody who acknowledges them:
  // the replay, or on policy the learner, leaves by itself when the heartbeat has been missing and
  // nothing comes any more.
  if (!on_policy) {
    plan.push_back(PlanProcess(run, ProcessName::Replay(0), "shoal-replay", {}, 1));
    plan.back().outlives_parent = true;
  }
  plan.push_back(
      PlanProcess(run, ProcessName::Learner(), "shoal-learner", {}, config.learner.threads));
  plan.back().outlives_parent = on_policy;
  const size_t first_expendable = plan.size();
  const int actors_here = hosts.empty() ? config.actors : ActorsOf(config, hosts, 0).first;
  for (int i = 0; i < actors_here; ++i) plan.push_back(ActorProcess(run, i));
  for (size_t host = 0; host < hosts.size(); ++host) {
    const ActorRange actors = ActorsOf(config, hosts, host);
    for (int i = actors.first; i < actors.first + actors.count; ++i) {
      plan.push_back(RemoteActor(hosts[host], i, run));
    }
  }
  plan.push_back(PlanProcess(run, ProcessName::Evaluation(), "shoal-actor", {"--role", "eval"}, 1));
  // A run in lockstep repeats bit for bit: it does not go on without one of its processes.
  for (size_t i = first_expendable; i < plan.size(); ++i) plan[i].expendable = !config.lockstep;
  return plan;
}

}  // namespace shoal::launch
