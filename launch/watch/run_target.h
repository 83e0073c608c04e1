// SPDX-License-Identifier: Apache-2.0
// Which running run a command is about: by name, by address, or the only one there is.
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
  std::string secure = {};  // folder of credentials; empty = as the run's cluster.json says
};

struct RunTarget {
  std::string name;                // for messages: the run's name or the peer
  std::string coordinator;         // for messages: its HOST:PORT
  std::filesystem::path folder{};  // empty when given by peer
  ClusterAddress address{};
  TransportConfig transport{};
};

// Folders in `dir` that are runs (have a config.json) or may not be looked into, sorted by name;
// empty when there is no `dir`. Throws Error when `dir` may not be read.
std::vector<std::filesystem::path> ListRuns(const std::filesystem::path& dir);

// Throws Error: both run and peer given, no such run, not running, none or several running.
RunTarget ResolveTarget(const TargetOptions& options);

}  // namespace shoal::launch
