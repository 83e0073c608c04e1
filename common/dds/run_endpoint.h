// SPDX-License-Identifier: Apache-2.0
// The addresses with which a process joins its run. The run folder has these addresses. Options of
// the command line replace them for processes on other hosts and for processes that a user starts
// by hand.
#pragma once

#include <filesystem>
#include <string>

#include "common/config/config.h"
#include "common/config/run_files.h"

namespace shoal::dds {

struct EndpointOptions {
  // Replaces the host and the domain of cluster.json: HOST, or the HOST:PORT that the run prints at
  // its start. Empty: not replaced.
  std::string peer;
  std::string interface;    // replaces config.json's transport.interface; empty: not replaced
  std::string secure = "";  // replaces cluster.json's folder of credentials; empty: not replaced
};

// Addresses of the run's servers, and the interface of this host that has the route to the servers.
struct RunEndpoint {
  ClusterAddress address;
  TransportConfig transport;
};

// The endpoint according to RUN/cluster.json and `transport`, after `options` were applied. Throws
// Error; the kind is kUsage if the peer is malformed.
RunEndpoint FindEndpoint(const std::filesystem::path& run, const TransportConfig& transport,
                         const EndpointOptions& options);

}  // namespace shoal::dds
