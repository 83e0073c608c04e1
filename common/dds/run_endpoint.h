// SPDX-License-Identifier: Apache-2.0
// The endpoint at which a process meets its run. Options of the command line replace parts of what
// the run folder says, for processes on other hosts or started by hand.
#pragma once

#include <filesystem>
#include <string>

#include "common/config/config.h"
#include "common/config/run_files.h"

namespace shoal::dds {

struct EndpointOptions {
  // HOST, or HOST:PORT as the run shows it when it starts, instead of cluster.json's host and
  // domain; empty = as cluster.json says.
  std::string peer;
  std::string interface;    // instead of config.json's transport.interface; empty = as that says
  std::string secure = "";  // instead of cluster.json's folder of credentials; empty = as that says
};

// Addresses of the run's servers, and the interface of this host that leads to them.
struct RunEndpoint {
  ClusterAddress address;
  TransportConfig transport;
};

// The endpoint that RUN/cluster.json and `transport` name, with `options` applied. Throws Error; a
// malformed peer is a usage error.
RunEndpoint FindEndpoint(const std::filesystem::path& run, const TransportConfig& transport,
                         const EndpointOptions& options);

}  // namespace shoal::dds
