// SPDX-License-Identifier: Apache-2.0
#include "launch/run/training_run.h"

#include <fmt/core.h>
#include <fmt/ranges.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/openmp_binding.h"
#include "common/base/stop.h"
#include "common/base/usable_cores.h"
#include "common/config/config_io.h"
#include "common/config/learner_threads.h"
#include "common/config/on_policy.h"
#include "common/config/privileged_blocks.h"
#include "common/config/run_files.h"
#include "common/config/sending_window.h"
#include "common/config/spec_mismatch.h"
#include "common/credentials/credentials.h"
#include "common/dds/bus.h"
#include "common/dds/role_rights.h"
#include "common/link/writer.h"
#include "common/nn/encoder_weights.h"
#include "common/nn/named_weights.h"
#include "common/nn/network_check.h"
#include "common/policy/checkpoint_writer.h"
#include "common/run_folder/run_file_names.h"
#include "common/spec/record.h"
#include "common/tasks/task_library.h"
#include "common/wire/weights_parts.h"
#include "launch/processes/actor_program.h"
#include "launch/processes/detachment.h"
#include "launch/processes/process_plan.h"
#include "launch/processes/run_hosts.h"
#include "launch/processes/run_leftovers.h"
#include "launch/processes/suspension.h"
#include "launch/record/run_folder.h"
#include "launch/run/coordinator.h"
#include "launch/run/live_settings.h"
#include "launch/run/operator_desk.h"
#include "launch/run/plan_text.h"
#include "launch/run/run_check.h"
#include "launch/run/run_end.h"
#include "launch/watch/prometheus_endpoint.h"
#include "launch/watch/terminal_block.h"
#include "learner/agent/algorithms.h"
#include "learner/agent/network_start.h"
#include "learner/agent/value_bounds.h"
#include "replay_server/core/hindsight.h"
#include "replay_server/core/replay_core.h"
#include "replay_server/core/storage_limits.h"
#include "replay_server/core/storage_needs.h"

namespace shoal::launch {
namespace {

// A run ready to start. Members are in construction order.
struct PreparedRun {
  RunFolder folder;
  RunConfig config;
  RunMeta meta;
  Hosts hosts;
  double frame_microseconds = 0;
  std::string camera_note{};  // which camera stands in for the default ones; empty = they are there
};

// The task chose cameras where the configuration's default ones are none of its own. From now on
// the configuration names them. Returns a line of the run's first ones, empty where nothing was
// chosen.
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

// The processes of a run whose coordinator was killed write into its folder until they have
// noticed: with --overwrite they would write into the new run's.
void WaitUntilNobodyWorksOn(const std::filesystem::path& run) {
  WaitForFormerProcesses(run, kFormerProcessesDeadline, StopRequested, [](const std::string& line) {
    fmt::print("{}\n", line);
    std::fflush(stdout);
  });
}

PreparedRun PrepareFresh(const TrainOptions& options, RunConfig config, Hosts hosts) {
  const Config& keys = config.config;
  if (options.overwrite && !keys.run_name.empty()) {
    const std::filesystem::path former = std::filesystem::path(keys.run_dir) / keys.run_name;
    if (!IsHeld(former)) WaitUntilNobodyWorksOn(former);  // else it is refused below
  }
  const std::string base =
      fmt::format("{}-s{}", keys.preset.empty() ? keys.task : keys.preset, keys.seed);
  RunFolder folder = keys.run_name.empty()
                         ? RunFolder::CreateNumbered(keys.run_dir, base)
                         : RunFolder::Create(keys.run_dir, keys.run_name, options.overwrite);
  config.config.run_name = folder.name();
  RunMeta meta;
  meta.started = UtcTimestamp();
  return {std::move(folder), std::move(config), meta, std::move(hosts)};
}

// Those the run had, or others in their place.
Hosts ResumedHosts(const TrainOptions& options, const std::filesystem::path& run,
                   const Config& config) {
  if (!std::filesystem::exists(HostsFile(run))) {
    if (options.hosts.empty()) return {};
    throw UsageError("--hosts: run '{}' was started without; it goes on without", run.string());
  }
  Hosts hosts = ReadHostsFile(options.hosts.empty() ? HostsFile(run).string() : options.hosts);
  CheckResumedHosts(hosts, config);
  return hosts;
}

// What --set changes of a run that was steered is one change more: the last one holds.
void NoteResumeOptions(const TrainOptions& options, const Config& before, RunMeta* meta) {
  if (before.lockstep) return;
  LiveSettings settings(before);
  settings.Restore(meta->changes);
  for (const std::string& assignment : options.set) {
    if (SetsForMachine(assignment)) continue;  // no setting of a running run; config.json has it
    SettingChange change = settings.Assign(assignment, meta->env_steps);
    change.time = UtcTimestamp();
    change.env_steps = meta->env_steps;
    change.updates = meta->updates;
    meta->changes.push_back(std::move(change));
  }
}

// The end of a run that has ended stays as it is unless something is asked of it.
void RefuseFinished(const std::filesystem::path& run, const RunMeta& meta, const Config& config,
                    const TrainOptions& options) {
  const bool ended = meta.exit == "budget" || meta.exit == "target";
  const bool evaluated = meta.final_return || config.eval.final_episodes == 0;
  if (!ended || !evaluated || !options.set.empty()) return;
  throw UsageError(
      "run '{}' is finished ({} at {} env steps): nothing is left to do; --set env_steps=N, or "
      "stop.success=2 where it reached its target, goes on",
      run.string(), meta.exit, meta.env_steps);
}

// Actors below this number run on this host.
uint32_t OwnActors(const TrainOptions& options, const std::filesystem::path& run, int actors) {
  if (!std::filesystem::exists(HostsFile(run))) return static_cast<uint32_t>(actors);
  int elsewhere = 0;
  Refusing("give --hosts FILE for others in their place", [&] {
    elsewhere = ReadHostsFile(options.hosts.empty() ? HostsFile(run).string() : options.hosts)
                    .RemoteActors();
  });
  return static_cast<uint32_t>(std::max(0, actors - elsewhere));
}

// What is damaged or missing is rebuilt, unless nothing is to be done.
void CheckFiles(const std::filesystem::path& run, const RunConfig& config, const RunMeta& meta,
                uint32_t own_actors, std::vector<std::string> lines, bool repair) {
  const RunCheck check = CheckRunFiles(run, config, meta, own_actors);
  lines.insert(lines.end(), check.lines.begin(), check.lines.end());
  for (const std::string& line : lines) fmt::print("{}\n", line);
  std::fflush(stdout);
  if (!repair) return;
  for (const auto& repaired : check.repairs) repaired();
}

RunConfig ReadConfigToGoOn(const std::filesystem::path& run) {
  RunConfig config;
  Refusing("a run cannot go on without it: restore it from a copy",
           [&] { config = ReadRunConfig(run); });
  return config;
}

// Refuses a checkpoint of another network, which the learner would find with every process running.
// A damaged checkpoint, or one of another version, is the learner's to refuse: it may take an older
// one.
void CheckResumedCheckpoint(const std::filesystem::path& run, const Config& config) {
  const std::filesystem::path folder = NewestCheckpoint(run);
  if (folder.empty()) return;
  CheckpointFiles files;
  try {
    files = ReadPolicyFiles(folder);
  } catch (const Error&) {
    return;
  }
  policy::CheckWriter(folder, files.state, files.description, config);
}

PreparedRun PrepareResumed(const TrainOptions& options) {
  RunFolder folder = RunFolder::Reopen(options.run_dir.empty() ? Config().run_dir : options.run_dir,
                                       options.resume);
  const bool only_shows = options.dry_run || options.print_config;
  if (!only_shows) WaitUntilNobodyWorksOn(folder.path());
  CheckKindsOfFiles(folder.path());
  RunConfig config = ReadConfigToGoOn(folder.path());
  const Config before = config.config;
  std::vector<std::string> lines;
  RunMeta meta = ReadMetaToGoOn(folder.path(), &lines);
  RefuseFinished(folder.path(), meta, before, options);
  meta.exit = "running";
  meta.final_return.reset();
  ApplyResumeOptions(options, UsableCores(), &config.config);
  tasks::LoadTaskLibrary(config.config.task_library);
  const ObservedWorld now = DescribeObservations(config.config);
  if (now.spec != config.spec) {
    throw RuntimeError("{}", SpecMismatch(config, now.spec));
  }
  if (meta.started.empty()) meta.started = UtcTimestamp();
  NoteResumeOptions(options, before, &meta);
  if (!options.print_config) {
    CheckResumedCheckpoint(folder.path(), config.config);
    CheckFiles(folder.path(), config, meta, OwnActors(options, folder.path(), config.config.actors),
               std::move(lines),
               /*repair=*/!only_shows);
  }
  Hosts hosts = ResumedHosts(options, folder.path(), config.config);
  return {std::move(folder), std::move(config), meta, std::move(hosts), now.frame_microseconds};
}

// What a receiver of weights takes, what the learner's threads can share, and that each has a core:
// the learner runs on this host.
void CheckNetwork(const RunConfig& run) {
  nn::CheckNetwork(run.config.network, run.spec, run.config.learner.batch,
                   int64_t{kMaxWeightsBytes});
  learner::ReplicasOf(run.config, run.spec, run.config.learner.threads);
  CheckCores(run.config.learner.threads, ReadCoreLimits());
}

// Runs `read`, which takes weights from a file; where they do not fit and the file is a
// checkpoint's, its refusal also says in what the networks differ.
template <class Read>
auto NamingBothNetworks(const std::string& file, const NetworkConfig& network, const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    const std::string difference = policy::DifferenceFromWriter(file, network);
    if (difference.empty()) throw;
    throw UsageError("{}; the networks differ: {}", error.what(), difference);
  }
}

// What --init-from names, by our names; empty without. Refused here is what the learner would
// refuse.
nn::TensorMap ReadInitialWeights(const TrainOptions& options, const RunConfig& run) {
  if (options.init_from.empty()) return {};
  if (!run.config.network.encoder_weights.empty()) {
    throw UsageError("--init-from: network.encoder_weights is set, too: expected one of both");
  }
  nn::TensorMap weights = nn::ReadNamedWeights(options.init_from, options.name_map);
  const auto agent = learner::MakeAgent(run.config, run.spec, nn::Precision::kF32);
  NamingBothNetworks(options.init_from, run.config.network,
                     [&] { return learner::StartTensors(weights, options.init_from, *agent); });
  return weights;
}

// The nearest folder of a run to be that exists. Throws Error where no run can be made in it.
std::filesystem::path CheckFolder(const Config& config) {
  std::error_code error;
  std::filesystem::path folder = std::filesystem::absolute(config.run_dir);
  while (!std::filesystem::exists(folder, error) && folder.has_relative_path()) {
    folder = folder.parent_path();
  }
  if (access(folder.c_str(), W_OK) != 0) {
    throw RuntimeError("cannot create folder '{}': {}",
                       (std::filesystem::path(config.run_dir) / config.run_name).string(),
                       std::strerror(errno));
  }
  return folder;
}

// Asked before anything is made or started. `folder`: of a run that exists; empty for a new one.
void CheckReplay(const RunConfig& run, const std::filesystem::path& folder) {
  const Config& config = run.config;
  CheckSendingWindow(config, RecordLayout(run.spec).record_bytes());
  if (LearnsOnPolicy(config)) {  // it has none
    if (folder.empty()) CheckFolder(config);
    return;
  }
  replay::CheckHindsight(run);
  replay::CheckSampling(run);
  learner::CheckValueBounds(run);
  const replay::StorageNeeds needs = replay::StorageNeedsOf(run);
  if (config.replay.storage == "memory") {
    replay::CheckMemoryRoom(needs.memory_bytes + needs.ring_bytes);
    return;
  }
  replay::CheckMemoryRoom(needs.memory_bytes, "stop other programs");  // it is never in the file
  if (folder.empty()) {
    replay::CheckDiskRoom(CheckFolder(config), needs.ring_bytes);
  } else if (!std::filesystem::exists(folder / kRingFile)) {
    replay::CheckDiskRoom(folder, needs.ring_bytes);
  }
}

// Wrapped on a terminal.
void PrintLines(const std::string& text) {
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    for (const std::string& row : LinesOnTerminal(line)) fmt::print("{}\n", row);
  }
  std::fflush(stdout);
}

void PrintStart(const PreparedRun& run, const ClusterAddress& address) {
  const Config& config = run.config.config;
  std::string text =
      fmt::format("run {}: {}\n", run.folder.path().string(), run.config.spec.Summary());
  text += fmt::format(
      "  seed {}, {} env steps; {}1 learner ({}), {} actor(s) of {} environments, "
      "1 evaluation actor; logs in {}\n",
      config.seed, config.env_steps, LearnsOnPolicy(config) ? "" : "1 replay, ",
      learner::DescribeThreads(config, run.config.spec, config.learner.threads, UsableCores()),
      config.actors, config.envs_per_actor, (run.folder.path() / kLogFolder).string());
  if (run.meta.env_steps > 0) {
    const std::filesystem::path checkpoint = NewestCheckpoint(run.folder.path());
    text +=
        fmt::format("  goes on at {} env steps, {}\n", run.meta.env_steps,
                    checkpoint.empty() ? "without a checkpoint" : "from " + checkpoint.string());
  }
  for (const std::string& binding : IgnoredOpenMpBindings()) {
    text += fmt::format("  {} is ignored: it would bind every process to the same core\n", binding);
  }
  text += run.camera_note + PlanText(run.config, run.frame_microseconds);
  const auto actors_here = TopologyOf(config, run.hosts.hosts).ActorsOn(0).size();
  const std::string shared = SharedCoresText(static_cast<int>(actors_here), UsableCores());
  if (!shared.empty()) text += "  " + shared + "\n";
  for (const RemoteHost& host : run.hosts.hosts) {
    text +=
        fmt::format("  {} of the actors on {}, in {}\n", host.actors, host.name, host.run.string());
  }
  text += fmt::format("  watch it with: shoal top --run {}, or --peer {}:{}\n",
                      run.folder.path().string(), address.host, dds::OperatePort(address));
  PrintLines(text);
}

std::string ServersHost(const Hosts& hosts) {
  return hosts.address.empty() ? ClusterAddress().host : hosts.address;
}

// Absolute: every process of the run reads it from cluster.json.
std::string SecureFolder(const TrainOptions& options) {
  if (options.secure.empty()) return "";
  return std::filesystem::absolute(options.secure).lexically_normal();
}

// Whether, and by which credentials, the run was secured.
std::string FormerSecurity(const std::filesystem::path& run) {
  if (!std::filesystem::exists(run / kClusterFile)) return "";  // killed before it was started
  std::string secure;
  Refusing("give --secure FOLDER where the run is secured, else remove the file",
           [&] { secure = ReadClusterAddress(run).secure; });
  return secure;
}

// Of every process that will be started: asked before any is.
void CheckRunCredentials(const std::string& secure) {
  if (secure.empty()) return;
  for (const RoleRights& rights : dds::AllRoleRights()) {
    if (rights.role == "client") continue;
    CheckCredentials(secure, rights.role, std::time(nullptr));
    CheckRights(secure, rights);
  }
}

void PrintDetached(const PreparedRun& run) {
  const std::string path = run.folder.path().string();
  fmt::print(
      "started in the background (coordinator pid {}): shoal attach --run {}, shoal stop "
      "--run {}\n",
      getpid(), path, path);
}

// `detachment` is null when the run stays with this terminal.
int Start(PreparedRun run, const TrainOptions& options, std::unique_ptr<dds::Bus> bus,
          const ClusterAddress& address, Detachment* detachment) {
  const std::filesystem::path& path = run.folder.path();
  WaitUntilNobodyWorksOn(path);
  RemoveUnfinishedFiles(path);
  std::optional<PrometheusEndpoint> prometheus;
  if (!options.prometheus.empty()) prometheus.emplace(options.prometheus);
  WriteRunConfig(path, run.config);
  run.meta.policy_inputs = PolicyInputsOf(run.config.spec);
  run.meta.privileged_inputs = PrivilegedInputsOf(run.config.config, run.config.spec);
  WriteClusterAddress(path, address);
  OperatorDesk desk(*bus, run.config.config.run_name, [&](const RunViewMessage& view) {
    if (prometheus) prometheus->Update(view);
  });
  Progress progress(
      LogFile(path, "coordinator").string(),
      [&desk](const std::string& line) { desk.AddEvent(line); },
      /*plain=*/detachment != nullptr);
  const auto say = [&](const std::string& line) { progress.Say(line); };
  if (!run.hosts.hosts.empty()) RefuseSuspension();
  PushToHosts(path, run.config.config, address.tag, &run.hosts, say, StopRequested);
  PrintStart(run, address);
  if (prometheus) PrintLines(fmt::format("  metrics for Prometheus at {}", prometheus->Url()));
  RunResult result;
  {
    Coordinator coordinator({.run = path,
                             .config = run.config.config,
                             .before = run.meta,
                             .hosts = run.hosts.hosts,
                             .hub = *bus,
                             .desk = desk,
                             .progress = progress});
    result = coordinator.Run([&] {
      if (detachment == nullptr) return;
      PrintDetached(run);
      detachment->Started(LogFile(path, "train"));
    });
  }
  const int stops = StopRequests();
  FetchFromHosts(path, run.config.config, run.hosts, say,
                 [stops] { return StopRequests() > stops; });
  const int exit_code =
      EndRun(path, run.config.config, TopologyOf(run.config.config, run.hosts.hosts),
             std::move(result), options.film, desk, progress);
  desk.ShowEnd(exit_code);
  return exit_code;
}

// With fewer the DDS library fails in ways of its own.
void CheckOpenFiles() {
  constexpr rlim_t kLeast = 32;
  struct rlimit limit {};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur >= kLeast) return;
  throw RuntimeError("a process may open {} files (ulimit -n): expected at least {}",
                     limit.rlim_cur, kLeast);
}

int Train(const TrainOptions& options, Detachment* detachment) {
  CheckOpenFiles();
  ClusterAddress address;
  if (!options.resume.empty()) {
    PreparedRun run = PrepareResumed(options);
    if (options.print_config) fmt::print("{}\n", ToJson(run.config.config).dump(2));
    if (options.print_config) return 0;
    CheckNetwork(run.config);
    CheckReplay(run.config, run.folder.path());
    CheckHosts(run.hosts, StopRequested);
    if (options.dry_run) return 0;
    address.host = ServersHost(run.hosts);
    address.secure =
        options.secure.empty() ? FormerSecurity(run.folder.path()) : SecureFolder(options);
    CheckRunCredentials(address.secure);
    if (!address.secure.empty()) KeepFilesPrivate();
    auto bus = dds::ClaimDomain(run.config.config.transport, &address);
    return Start(std::move(run), options, std::move(bus), address, detachment);
  }
  RunConfig config{ResolveConfig(options, UsableCores()), {}};
  Hosts hosts;
  if (!options.hosts.empty()) {
    hosts = ReadHostsFile(options.hosts);
    ApplyHosts(hosts, &config.config);
  }
  if (options.print_config) {
    fmt::print("{}\n", ToJson(config.config).dump(2));
    return 0;
  }
  tasks::LoadTaskLibrary(config.config.task_library);
  const ObservedWorld world = DescribeObservations(config.config);
  config.spec = world.spec;
  const std::string camera_note = TakeCameras(&config);
  PrivilegedBlocksOf(config.config.learner, config.spec);  // refused here
  CheckNetwork(config);
  const NetworkConfig& network = config.config.network;
  NamingBothNetworks(network.encoder_weights, network, [&] {  // the learner will; refused here
    return nn::ReadEncoderWeights(network, config.spec);
  });
  const nn::TensorMap initial = ReadInitialWeights(options, config);
  CheckReplay(config, {});
  CheckHosts(hosts, StopRequested);
  address.host = ServersHost(hosts);
  address.secure = SecureFolder(options);
  CheckRunCredentials(address.secure);
  if (!address.secure.empty()) KeepFilesPrivate();
  if (!options.prometheus.empty()) PrometheusEndpoint::Check(options.prometheus);
  // Claimed before the folder is made, so that a failure leaves nothing half-written.
  auto bus = dds::ClaimDomain(config.config.transport, &address);
  if (options.dry_run) {
    fmt::print("configuration is good; actors observe: {}\n", config.spec.Summary());
    return 0;
  }
  PreparedRun run = PrepareFresh(options, std::move(config), std::move(hosts));
  run.frame_microseconds = world.frame_microseconds;
  run.camera_note = camera_note;
  if (!initial.empty()) {
    WriteFileAtomically(run.folder.path() / kInitialWeightsFile, nn::WriteSafetensors(initial, {}));
  }
  return Start(std::move(run), options, std::move(bus), address, detachment);
}

}  // namespace

int RunTraining(const TrainOptions& options) {
  InstallStopSignals();
  if (!options.detach) {
    SuspendWithChildren();
    return Train(options, nullptr);
  }
  Detachment detachment;  // before there are threads
  return detachment.IsChild() ? Train(options, &detachment) : detachment.exit_code();
}

}  // namespace shoal::launch
