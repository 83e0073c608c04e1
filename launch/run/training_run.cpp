// SPDX-License-Identifier: Apache-2.0
#include "launch/run/training_run.h"

#include <fmt/core.h>
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <utility>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/stop.h"
#include "common/config/config_io.h"
#include "common/config/run_files.h"
#include "common/dds/bus.h"
#include "common/link/plane_hub.h"
#include "common/run_folder/run_file_names.h"
#include "launch/processes/detachment.h"
#include "launch/processes/process_plan.h"
#include "launch/processes/run_hosts.h"
#include "launch/processes/run_leftovers.h"
#include "launch/processes/suspension.h"
#include "launch/run/coordinator.h"
#include "launch/run/in_process_roles.h"
#include "launch/run/request_check.h"
#include "launch/run/resumed_run.h"
#include "launch/run/run_end.h"
#include "launch/run/run_request.h"
#include "launch/run/run_server.h"
#include "launch/run/start_text.h"
#include "launch/watch/prometheus_endpoint.h"
#include "launch/watch/terminal_block.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

// Prints the text; on a terminal, wraps its lines.
void PrintLines(const std::string& text) {
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    for (const std::string& row : LinesOnTerminal(line)) fmt::print("{}\n", row);
  }
  std::fflush(stdout);
}

void PrintDetached(const fs::path& run) {
  fmt::print(
      "started in the background (coordinator pid {}): shoal attach --run {}, shoal stop "
      "--run {}\n",
      getpid(), run.string(), run.string());
}

// The address of the run's servers and the folder of its credentials.
ClusterAddress AddressOf(const TrainOptions& options, const RunRequest& request) {
  ClusterAddress address;
  if (!request.hosts.address.empty()) address.host = request.hosts.address;
  if (!options.secure.empty()) {
    // Absolute, because every process of the run reads the path from cluster.json.
    address.secure = fs::absolute(options.secure).lexically_normal();
  } else if (request.resumed()) {
    address.secure = FormerSecurity(request.folder->path());
  }
  return address;
}

// Refuses options that require separate processes.
void CheckInProcess(bool hosts, bool secured) {
  const auto refuse = [](const char* what, const char* why) {
    throw UsageError("--in-process: not with {}: {}", what, why);
  };
  if (hosts) refuse("other hosts (--hosts)", "all roles are threads of this process");
  if (secured) refuse("a secured run (--secure)", "the roles of one process share its memory");
}

// Writes the files that the processes of the run read.
void WriteStartFiles(const fs::path& run, const ClusterAddress& address, RunRequest* request) {
  WriteRunConfig(run, request->config);
  request->meta.policy_inputs = PolicyInputsOf(request->config.spec);
  request->meta.privileged_inputs =
      PrivilegedInputsOf(request->config.config, request->config.spec);
  WriteClusterAddress(run, address);
  std::error_code none;
  fs::remove(run / kLearnerDeviceFile, none);  // losses of GPUs count from this start on
}

// Trains in `folder` until the run ends, then evaluates it. `detachment` is null if the run stays
// in the foreground.
int Start(RunRequest request, const RunFolder& folder, const TrainOptions& options, link::Hub& hub,
          const ClusterAddress& address, Detachment* detachment) {
  const fs::path& path = folder.path();
  const Config& config = request.config.config;
  WaitUntilUnused(path);
  RemoveUnfinishedFiles(path);
  std::optional<PrometheusEndpoint> prometheus;
  if (!options.prometheus.empty()) prometheus.emplace(options.prometheus);
  WriteStartFiles(path, address, &request);
  RunServer server(hub, config.run_name, [&](const RunViewMessage& view) {
    if (prometheus) prometheus->Update(view);
  });
  Progress progress(
      LogFile(path, "coordinator").string(),
      [&server](const std::string& line) { server.AddEvent(line); },
      /*plain=*/detachment != nullptr);
  const auto say = [&](const std::string& line) { progress.Say(line); };
  Hosts& hosts = request.hosts;
  if (!hosts.hosts.empty()) RefuseSuspension();
  PushToHosts(path, config, address.tag, &hosts, say, StopRequested);
  PrintLines(StartText(request, path, address));
  if (prometheus) PrintLines(fmt::format("  metrics for Prometheus at {}", prometheus->Url()));
  RunResult result;
  {
    std::optional<InProcessRoles> roles;
    std::optional<link::PlaneHub> roles_hub;
    ProcessStarter start = StartChild;
    if (options.in_process) {
      roles.emplace(path, config);
      roles_hub.emplace(roles->coordinator(), hub);
      start = [&roles](const ProcessSpec& spec) { return roles->Start(spec); };
    }
    Coordinator coordinator({.run = path,
                             .config = config,
                             .before = request.meta,
                             .hosts = hosts.hosts,
                             .hub = roles_hub ? *roles_hub : hub,
                             .server = server,
                             .progress = progress,
                             .start = start,
                             .split_limits = request.split_limits});
    result = coordinator.Run([&] {
      if (detachment == nullptr) return;
      PrintDetached(path);
      detachment->Started(LogFile(path, "train"));
    });
  }
  const int stops = StopRequests();
  FetchFromHosts(path, config, hosts, say, [stops] { return StopRequests() > stops; });
  const int exit_code = EndRun(path, config, TopologyOf(config, hosts.hosts), std::move(result),
                               options.film, server, progress);
  server.ShowEnd(exit_code);
  return exit_code;
}

// Resolves, checks and starts the run. The folder of a fresh run is created last, so a refusal
// leaves no files.
int Train(const TrainOptions& options, Detachment* detachment) {
  CheckOpenFiles();
  RunRequest request = options.resume.empty() ? ResolveFresh(options) : ResolveResumed(options);
  if (options.print_config) {
    fmt::print("{}\n", ToJson(request.config.config).dump(2));
    return 0;
  }
  if (options.in_process && !request.config.config.env.id.empty()) {
    throw UsageError("--in-process: not with env.id: the environment runs in processes of its own");
  }
  CheckRequest(options, &request);
  // The dry run of a resumed run claims no DDS domain, because the run had one before.
  if (options.dry_run && request.resumed()) return 0;
  ClusterAddress address = AddressOf(options, request);
  if (options.in_process) {
    CheckInProcess(!request.hosts.hosts.empty(), !address.secure.empty());
  }
  CheckRunCredentials(address.secure);
  if (!address.secure.empty()) KeepFilesPrivate();
  if (!options.prometheus.empty()) PrometheusEndpoint::Check(options.prometheus);
  const std::unique_ptr<dds::Bus> bus = dds::ClaimDomain(request.config.config.transport, &address);
  if (options.dry_run) {
    fmt::print("configuration is valid; actors observe: {}\n", request.config.spec.Summary());
    return 0;
  }
  const RunFolder folder = TakeFolder(options, &request);
  return Start(std::move(request), folder, options, *bus, address, detachment);
}

}  // namespace

int RunTraining(const TrainOptions& options) {
  if (options.in_process) {
    CheckInProcess(!options.hosts.empty(), !options.secure.empty());
    PrepareForRolesInProcess();
  }
  InstallStopSignals();
  if (!options.detach) {
    SuspendWithChildren();
    return Train(options, nullptr);
  }
  Detachment detachment;  // forks, so it precedes all threads
  return detachment.IsChild() ? Train(options, &detachment) : detachment.exit_code();
}

}  // namespace shoal::launch
