// SPDX-License-Identifier: Apache-2.0
#include "launch/run/run_request.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <utility>

#include "actor/hosted/hosted_spec.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/stop.h"
#include "common/base/usable_cores.h"
#include "common/config/privileged_blocks.h"
#include "common/run_folder/run_file_names.h"
#include "common/tasks/environment_description.h"
#include "common/tasks/task_library.h"
#include "launch/processes/actor_program.h"
#include "launch/processes/run_hosts.h"
#include "launch/processes/run_leftovers.h"
#include "launch/run/environment_choice.h"
#include "launch/run/first_split.h"

namespace shoal::launch {
namespace {

// If the task has none of the configured cameras and chose others, writes these into the
// configuration. Returns a line for the start; empty if nothing was chosen.
std::string TakeCameras(RunConfig* run) {
  std::vector<std::string>& cameras = run->config.observation.cameras;
  if (!run->spec.HasPixels() || cameras == run->spec.cameras) return "";
  const std::string note = fmt::format(
      "  {} has no cameras {}: the policy sees through {}, the task's first "
      "(observation.cameras)\n",
      run->config.task, fmt::join(cameras, " and "), fmt::join(run->spec.cameras, ", "));
  cameras = run->spec.cameras;
  return note;
}

// Sets the first division of the cores if the run chooses its division.
void DivideCores(double step_microseconds, RunRequest* request) {
  if (!request->split_limits) return;
  const auto costs = ExpectedCosts(request->config, step_microseconds);
  if (!costs) return;
  const Split split = BestSplit(*costs, *request->split_limits);
  request->config.config.actors = split.actors;
  request->config.config.learner.threads = split.threads;
}

// The interpreter, or the program that loads the environment's library.
std::string RunnerOf(const Config& config) {
  return config.env.python.empty() ? "shoal-actor" : config.env.python;
}

void RefuseOtherHosts(const Config& config, const Hosts& hosts) {
  if (hosts.hosts.empty()) return;
  throw UsageError("--hosts: the environment {} is run by {} of this host; expected no other hosts",
                   config.env.id, RunnerOf(config));
}

// Queries the observations of the environment env.id and resolves the configuration again with the
// defaults for them.
void TakeEnvironment(const TrainOptions& options, RunRequest* request) {
  RunConfig& run = request->config;
  const DescribedEnvironment described = DescribeEnvironment(run.config);
  const tasks::EnvironmentDescription& environment = described.description;
  const std::string preset = run.config.preset;
  const EnvironmentDefaults defaults = DefaultsFor(environment);
  run.config = ResolveConfig(options, UsableCores(), defaults);
  run.spec = hosted::SpecOf(environment, run.config);
  if (run.spec.HasPixels()) run.config.observation.cameras = run.spec.cameras;
  tasks::AddEnvironmentTask(run.spec.environment);
  request->split_limits = LimitsOfSplit(GivenConfig(options, defaults), false, UsableCores());
  DivideCores(described.step_microseconds, request);
  request->environment_note = fmt::format(
      "  environment {}, run by {}{}\n", run.config.env.id, RunnerOf(run.config),
      preset.empty() ? fmt::format("; preset {}, because {}", run.config.preset, defaults.reason)
                     : "");
}

RunFolder CreateFolder(const TrainOptions& options, const Config& config) {
  if (config.run_name.empty()) {
    // Presets for environments are general, so the environment's name describes the run better.
    const bool by_task = config.preset.empty() || !config.env.id.empty();
    const std::string& kind = by_task ? config.task : config.preset;
    return RunFolder::CreateNumbered(config.run_dir, fmt::format("{}-s{}", kind, config.seed));
  }
  const std::filesystem::path folder = std::filesystem::path(config.run_dir) / config.run_name;
  // If --overwrite replaced a run whose processes still write, they would write into the new run.
  // If a coordinator holds the old run, Create refuses.
  if (options.overwrite && !IsHeld(folder)) WaitUntilUnused(folder);
  return RunFolder::Create(config.run_dir, config.run_name, options.overwrite);
}

}  // namespace

void WaitUntilUnused(const std::filesystem::path& run) {
  WaitForFormerProcesses(run, kFormerProcessesDeadline, StopRequested, [](const std::string& line) {
    fmt::print("{}\n", line);
    std::fflush(stdout);
  });
}

RunRequest ResolveFresh(const TrainOptions& options) {
  RunRequest request{.config = {ResolveConfig(options, UsableCores()), {}}};
  Config& config = request.config.config;
  if (!options.hosts.empty()) {
    request.hosts = ReadHostsFile(options.hosts);
    ApplyHosts(request.hosts, &config);
  }
  if (!config.env.id.empty()) {
    RefuseOtherHosts(config, request.hosts);
    TakeEnvironment(options, &request);
  }
  if (options.print_config) return request;
  if (config.env.id.empty()) {
    tasks::LoadTaskLibrary(config.task_library);
    const ObservedWorld world = DescribeObservations(config);
    request.config.spec = world.spec;
    request.frame_microseconds = world.frame_microseconds;
    request.split_limits =
        LimitsOfSplit(GivenConfig(options), !request.hosts.hosts.empty(), UsableCores());
    DivideCores(world.step_microseconds, &request);
    request.camera_note = TakeCameras(&request.config);
  }
  PrivilegedBlocksOf(config, request.config.spec);  // throws for unknown blocks
  return request;
}

RunFolder TakeFolder(const TrainOptions& options, RunRequest* request) {
  if (request->resumed()) return std::move(*request->folder);
  RunFolder folder = CreateFolder(options, request->config.config);
  request->config.config.run_name = folder.name();
  request->meta.started = UtcTimestamp();
  if (!request->initial_weights.empty()) {
    WriteFileAtomically(folder.path() / kInitialWeightsFile,
                        nn::WriteSafetensors(request->initial_weights, {}));
  }
  return folder;
}

}  // namespace shoal::launch
