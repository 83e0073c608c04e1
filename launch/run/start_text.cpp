// SPDX-License-Identifier: Apache-2.0
#include "launch/run/start_text.h"

#include <fmt/core.h>

#include "common/base/openmp_binding.h"
#include "common/base/usable_cores.h"
#include "common/dds/bus.h"
#include "common/run_folder/run_file_names.h"
#include "launch/processes/process_plan.h"
#include "launch/run/plan_text.h"
#include "learner/agent/algorithms.h"

namespace shoal::launch {

namespace {

// Which processor `auto` chooses is known when the learner has started.
std::string LearnerText(const RunConfig& run) {
  const LearnerConfig& learner = run.config.learner;
  if (learner.device == "cuda") return "on a GPU";
  const std::string threads =
      learner::DescribeThreads(run.config, run.spec, learner.threads, UsableCores());
  return learner.device == "auto" ? "on a GPU, else with " + threads : threads;
}

}  // namespace

std::string StartText(const RunRequest& request, const std::filesystem::path& run,
                      const ClusterAddress& address) {
  const Config& config = request.config.config;
  const link::RunTopology topology = TopologyOf(config, request.hosts.hosts);
  const size_t replays = topology.Of(link::Role::kReplay).size();
  std::string text = fmt::format("run {}: {}\n", run.string(), request.config.spec.Summary());
  text += fmt::format(
      "  seed {}, {} env steps; {}{} learner ({}), {} actor(s) of {} environments, {} evaluation "
      "actor; logs in {}\n",
      config.seed, config.env_steps, replays == 0 ? "" : fmt::format("{} replay, ", replays),
      topology.Of(link::Role::kLearner).size(), LearnerText(request.config), config.actors,
      config.envs_per_actor, topology.Of(link::Role::kEval).size(), (run / kLogFolder).string());
  if (request.meta.env_steps > 0) {
    const std::filesystem::path checkpoint = NewestCheckpoint(run);
    text +=
        fmt::format("  goes on at {} env steps, {}\n", request.meta.env_steps,
                    checkpoint.empty() ? "without a checkpoint" : "from " + checkpoint.string());
  }
  for (const std::string& binding : IgnoredOpenMpBindings()) {
    text += fmt::format("  {} is ignored: it would bind every process to the same core\n", binding);
  }
  text += request.environment_note + request.camera_note +
          PlanText(request.config, request.frame_microseconds);
  const auto actors_here = static_cast<int>(topology.ActorsOn(0).size());
  const std::string shared = SharedCoresText(actors_here, UsableCores());
  if (!shared.empty()) text += "  " + shared + "\n";
  for (const RemoteHost& host : request.hosts.hosts) {
    text +=
        fmt::format("  {} of the actors on {}, in {}\n", host.actors, host.name, host.run.string());
  }
  text += fmt::format("  watch it with: shoal top --run {}, or --peer {}:{}\n", run.string(),
                      address.host, dds::OperatePort(address));
  return text;
}

}  // namespace shoal::launch
