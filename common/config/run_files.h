// SPDX-License-Identifier: Apache-2.0
// Files of a run folder that its processes read: config.json (schema shoal-config-1: every key, the
// observation spec and its hash) and cluster.json (schema shoal-cluster-1: addresses, domain,
// credentials).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/config/run_config.h"

namespace shoal {

// The content of config.json.
std::string RunConfigText(const RunConfig& config);
void WriteRunConfig(const std::filesystem::path& run, const RunConfig& config);
// Throws Error on a missing, malformed or inconsistent file (spec and stored hash differ).
RunConfig ReadRunConfig(const std::filesystem::path& run);

// Address at which the processes of a run find each other. The odd domain above `domain` carries
// batches.
struct ClusterAddress {
  int domain = 0;                  // even, below 100
  std::string tag;                 // run id: processes with another tag do not see each other
  std::string host = "127.0.0.1";  // of coordinator, replay and learner
  std::string secure = {};         // folder of credentials (common/credentials); empty = none
};

void WriteClusterAddress(const std::filesystem::path& run, const ClusterAddress& address);
ClusterAddress ReadClusterAddress(const std::filesystem::path& run);

// In a secured run, what this process makes belongs to its user alone. `shoal train` sees to it for
// the processes that it starts; this is for those that are started by hand. Before there are
// threads. Throws Error.
void KeepSecuredRunPrivate(const std::filesystem::path& run);

}  // namespace shoal
