// SPDX-License-Identifier: Apache-2.0
// Finds the running run to which a command applies: by name, by address, or as the only run that is
// running.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/config/run_files.h"

namespace shoal::launch {

struct TargetOptions {
  std::string run;   // name within run_dir, or path of the folder
  std::string peer;  // HOST:PORT at which the coordinator accepts clients
  std::string run_dir = "runs";
  std::string secure = {};  // folder of credentials; empty = as in the run's cluster.json
};

struct RunTarget {
  std::string name;                // for messages: the run's name or the peer
  std::string coordinator;         // for messages: HOST:PORT of the coordinator
  std::filesystem::path folder{};  // empty if the run was given by --peer
  ClusterAddress address{};
  TransportConfig transport{};
};

// Folders in `dir` that are runs (have a config.json) or that this user may not read, sorted by
// name; empty if `dir` does not exist. Throws Error if this user may not read `dir`.
std::vector<std::filesystem::path> ListRuns(const std::filesystem::path& dir);

// Finds the run. Throws Error if both run and peer are given, if there is no such run or the run is
// not running, or if neither is given and not exactly one run is running.
RunTarget ResolveTarget(const TargetOptions& options);

}  // namespace shoal::launch
