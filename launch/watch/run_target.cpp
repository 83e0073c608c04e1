// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/run_target.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/dds/bus.h"
#include "common/run_folder/run_file_names.h"
#include "launch/record/run_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

std::string CoordinatorAt(const ClusterAddress& address) {
  return fmt::format("{}:{}", address.host, dds::OperatePort(address));
}

RunTarget TargetOfFolder(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::exists(folder / kClusterFile, ignored)) {
    throw RuntimeError("run '{}' is starting and cannot be reached yet: try again",
                       folder.filename().string());
  }
  const ClusterAddress address = ReadClusterAddress(folder);
  return {.name = folder.filename().string(),
          .coordinator = CoordinatorAt(address),
          .folder = folder,
          .address = address,
          .transport = ReadRunConfig(folder).config.transport};
}

RunTarget TargetOfPeer(const std::string& peer) {
  const ClusterAddress address = dds::ParsePeer(peer);
  RunTarget target{.name = peer,
                   .coordinator = CoordinatorAt(address),
                   .folder = {},
                   .address = address,
                   .transport = {}};
  target.transport.interface = dds::InterfaceTowards(target.address.host);
  return target;
}

fs::path OnlyRunningRun(const std::string& dir) {
  std::vector<fs::path> running;
  std::string names;
  for (const fs::path& run : ListRuns(dir)) {
    if (!IsHeld(run)) continue;
    running.push_back(run);
    names += (names.empty() ? "" : ", ") + run.filename().string();
  }
  if (running.empty()) {
    throw RuntimeError("no run is running in '{}' (another folder: --run-dir; elsewhere: --peer)",
                       dir);
  }
  if (running.size() > 1) {
    throw UsageError("{} runs are running in '{}': choose one with --run: {}", running.size(), dir,
                     names);
  }
  return running[0];
}

}  // namespace

std::vector<fs::path> ListRuns(const fs::path& dir) {
  std::vector<fs::path> runs;
  std::error_code error;
  for (fs::directory_iterator it(dir, error), end; !error && it != end; it.increment(error)) {
    if (IsRun(it->path()) || IsForbidden(it->path())) runs.push_back(it->path());
  }
  if (error == std::errc::permission_denied) {
    throw RuntimeError("cannot read '{}': {}", dir.string(), error.message());
  }
  std::ranges::sort(runs);
  return runs;
}

RunTarget ResolveTarget(const TargetOptions& options) {
  if (!options.run.empty() && !options.peer.empty()) {
    throw UsageError("--run {} and --peer {}: give one of them", options.run, options.peer);
  }
  if (!options.peer.empty()) {
    RunTarget target = TargetOfPeer(options.peer);
    target.address.secure = options.secure;
    return target;
  }
  const fs::path folder =
      options.run.empty() ? OnlyRunningRun(options.run_dir)
                          : fs::weakly_canonical(FindNamed(options.run, RunsIn(options.run_dir)));
  if (!IsHeld(folder)) throw RuntimeError("run '{}' is not running", folder.string());
  RunTarget target = TargetOfFolder(folder);
  if (!options.secure.empty()) target.address.secure = options.secure;
  return target;
}

}  // namespace shoal::launch
