// SPDX-License-Identifier: Apache-2.0
// Finds the running run that a command is for: by name, by address, or the only one that runs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/config/config.h"
#include "common/config/run_files.h"

namespace shoal::launch {

struct TargetOptions {
  std::string run;   // name within run_dir, or path of the folder
  std::string peer;  // HOST:PORT of the coordinator's side for clients
  std::string run_dir = "runs";
  std::string secure = {};  // folder of credentials; empty = the one in the run's cluster.json
};

struct RunTarget {
  std::string name;                // for messages: the run's name or the peer
  std::string coordinator;         // for messages: its HOST:PORT
  std::filesystem::path folder{};  // empty when given by peer
  ClusterAddress address{};
  TransportConfig transport{};
};

// Folders in `dir` that are runs (have a config.json) or that this user may not read, sorted by
// name; empty if `dir` does not exist. Throws Error if this user may not read `dir`.
std::vector<std::filesystem::path> ListRuns(const std::filesystem::path& dir);

// Throws Error: both run and peer given, no such run, not running, none or several running.
RunTarget ResolveTarget(const TargetOptions& options);

}  // namespace shoal::launch
