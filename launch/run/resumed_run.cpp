// SPDX-License-Identifier: Apache-2.0
#include "launch/run/resumed_run.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "actor/hosted/hosted_spec.h"
#include "common/base/bounded_json.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/usable_cores.h"
#include "common/config/on_policy.h"
#include "common/config/run_files.h"
#include "common/config/spec_mismatch.h"
#include "common/policy/checkpoint_writer.h"
#include "common/run_folder/run_file_names.h"
#include "common/tasks/environment_description.h"
#include "common/tasks/task_library.h"
#include "launch/processes/run_hosts.h"
#include "launch/run/live_settings.h"
#include "launch/run/run_check.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

RunConfig ReadConfigToGoOn(const fs::path& run) {
  RunConfig config;
  Refusing("a run cannot go on without it: restore it from a copy",
           [&] { config = ReadRunConfig(run); });
  return config;
}

// Refuses to resume a finished and evaluated run unless --set is given, for example to raise its
// budget.
void RefuseFinished(const fs::path& run, const RunMeta& meta, const Config& config,
                    const TrainOptions& options) {
  const bool ended = meta.exit == "budget" || meta.exit == "target";
  const bool evaluated = meta.final_return || config.eval.final_episodes == 0;
  if (!ended || !evaluated || !options.set.empty()) return;
  throw UsageError(
      "run '{}' is finished ({} at {} env steps). To continue: --set env_steps=N, or --set "
      "stop.success=2 if it reached its target",
      run.string(), meta.exit, meta.env_steps);
}

// Appends the values of --set to the run's recorded changes, where the last change of a key holds.
// `now`: the configuration with these values.
void NoteResumeOptions(const TrainOptions& options, const Config& before, const Config& now,
                       RunMeta* meta) {
  if (before.lockstep) return;
  LiveSettings settings(before);
  settings.Restore(meta->changes);
  for (const std::string& assignment : options.set) {
    const bool threads = assignment.starts_with("learner.threads=");
    if (SetsForMachine(assignment) && !threads) continue;  // not live; config.json has it
    if (threads && LearnsOnPolicy(before)) continue;
    SettingChange change = settings.Assign(
        threads ? fmt::format("learner.threads={}", now.learner.threads) : assignment,
        meta->env_steps);
    change.time = UtcTimestamp();
    change.env_steps = meta->env_steps;
    change.updates = meta->updates;
    meta->changes.push_back(std::move(change));
  }
}

// Refuses a checkpoint of another network before any process starts. A checkpoint that is damaged
// or of another version is left to the learner, which may continue from an older checkpoint.
void CheckResumedCheckpoint(const fs::path& run, const Config& config) {
  const fs::path folder = NewestCheckpoint(run);
  if (folder.empty()) return;
  CheckpointFiles files;
  try {
    files = ReadPolicyFiles(folder);
  } catch (const Error&) {
    return;
  }
  policy::CheckWriter(folder, files.state, files.description, config);
}

// The file of --hosts, else the run's own hosts file.
fs::path HostsToGoOn(const TrainOptions& options, const fs::path& run) {
  return options.hosts.empty() ? HostsFile(run) : fs::path(options.hosts);
}

// Number of actors on this host; their ids are below this number.
uint32_t OwnActors(const TrainOptions& options, const fs::path& run, int actors) {
  if (!fs::exists(HostsFile(run))) return static_cast<uint32_t>(actors);
  int elsewhere = 0;
  Refusing("give --hosts FILE for others in their place",
           [&] { elsewhere = ReadHostsFile(HostsToGoOn(options, run)).RemoteActors(); });
  return static_cast<uint32_t>(std::max(0, actors - elsewhere));
}

// Prints `lines` and the findings of the check. With `repair`, rebuilds damaged or missing files.
void CheckFiles(const fs::path& run, const RunConfig& config, const RunMeta& meta,
                uint32_t own_actors, std::vector<std::string> lines, bool repair) {
  const RunCheck check = CheckRunFiles(run, config, meta, own_actors);
  lines.insert(lines.end(), check.lines.begin(), check.lines.end());
  for (const std::string& line : lines) fmt::print("{}\n", line);
  std::fflush(stdout);
  if (!repair) return;
  for (const auto& repaired : check.repairs) repaired();
}

Hosts ResumedHosts(const TrainOptions& options, const fs::path& run, const Config& config) {
  if (!fs::exists(HostsFile(run))) {
    if (options.hosts.empty()) return {};
    throw UsageError("--hosts: run '{}' was started without other hosts: expected no --hosts",
                     run.string());
  }
  Hosts hosts = ReadHostsFile(HostsToGoOn(options, run));
  CheckResumedHosts(hosts, config);
  return hosts;
}

// Whether the reward for relabelled goals is unchanged. Thresholds are compared with a tolerance,
// because each start estimates the threshold from samples.
bool HasGoalOf(const tasks::EnvironmentDescription& was, const tasks::EnvironmentDescription& now) {
  constexpr double kTolerance = 1e-5;  // relative
  if (!was.goal) return true;
  return now.goal && now.goal->reward == was.goal->reward &&
         std::abs(now.goal->threshold - was.goal->threshold) <= kTolerance * was.goal->threshold;
}

// The world that the actors observe now. Keeps two findings of the first start: whether steps
// report success, and the goal if its rewards are unchanged.
ObservedWorld ObserveEnvironmentAgain(const RunConfig& run) {
  tasks::EnvironmentDescription now = DescribeEnvironment(run.config).description;
  const tasks::EnvironmentDescription was =
      tasks::EnvironmentFromJson(ParseBoundedJson<nlohmann::json>(run.spec.environment));
  if (HasGoalOf(was, now)) {
    now.TakeFindings(was);
  } else {
    now.success = was.success;
  }
  return {.spec = hosted::SpecOf(now, run.config)};
}

}  // namespace

RunRequest ResolveResumed(const TrainOptions& options,
                          const std::function<ObservedWorld(const Config&)>& describe) {
  RunFolder folder = RunFolder::Reopen(options.run_dir.empty() ? Config().run_dir : options.run_dir,
                                       options.resume);
  const fs::path run = folder.path();
  const bool only_shows = options.dry_run || options.print_config;
  if (!only_shows) WaitUntilUnused(run);
  CheckKindsOfFiles(run);
  RunRequest request{.config = ReadConfigToGoOn(run)};
  Config& config = request.config.config;
  const Config before = config;
  std::vector<std::string> lines;
  request.meta = ReadMetaToGoOn(run, &lines);
  RefuseFinished(run, request.meta, before, options);
  request.meta.exit = "running";
  request.meta.final_return.reset();
  ApplyResumeOptions(options, UsableCores(), &config);
  tasks::LoadTaskLibrary(config.task_library);
  tasks::AddEnvironmentTask(request.config.spec.environment);
  const ObservedWorld world =
      config.env.id.empty() ? describe(config) : ObserveEnvironmentAgain(request.config);
  if (world.spec != request.config.spec) {
    throw RuntimeError("{}", SpecMismatch(request.config, world.spec));
  }
  request.frame_microseconds = world.frame_microseconds;
  if (request.meta.started.empty()) request.meta.started = UtcTimestamp();
  NoteResumeOptions(options, before, config, &request.meta);
  if (!options.print_config) {
    CheckResumedCheckpoint(run, config);
    CheckFiles(run, request.config, request.meta, OwnActors(options, run, config.actors),
               std::move(lines), /*repair=*/!only_shows);
  }
  request.hosts = ResumedHosts(options, run, config);
  request.folder = std::move(folder);
  return request;
}

std::string FormerSecurity(const fs::path& run) {
  if (!fs::exists(run / kClusterFile)) return "";  // killed before its start
  std::string secure;
  Refusing("give --secure FOLDER where the run is secured, else remove the file",
           [&] { secure = ReadClusterAddress(run).secure; });
  return secure;
}

}  // namespace shoal::launch
