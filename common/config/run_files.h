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
// Throws Error if the file is missing, malformed or inconsistent (spec and stored hash differ).
RunConfig ReadRunConfig(const std::filesystem::path& run);

// Address at which the processes of a run find each other. The DDS domain `domain` + 1 carries
// batches and the messages of clients; the domain `domain` carries all other messages.
struct ClusterAddress {
  int domain = 0;                  // even, below 100
  std::string tag;                 // run id: DDS connects only processes with the same tag
  std::string host = "127.0.0.1";  // host of coordinator, replay and learner
  std::string secure = {};  // folder of credentials (common/credentials); empty = not secured
};

void WriteClusterAddress(const std::filesystem::path& run, const ClusterAddress& address);
ClusterAddress ReadClusterAddress(const std::filesystem::path& run);

// If the run is secured, makes the files of this process private to its user (KeepFilesPrivate).
// `shoal train` does the same for the processes that it starts. A process that a user starts by
// hand calls this function, before other threads exist. Throws Error.
void KeepSecuredRunPrivate(const std::filesystem::path& run);

}  // namespace shoal
