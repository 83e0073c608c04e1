// SPDX-License-Identifier: Apache-2.0
// The addresses with which a process joins its run. For processes on other hosts, or started by
// hand, options of the command line replace parts of the run folder's settings.
#pragma once

#include <filesystem>
#include <string>

#include "common/config/config.h"
#include "common/config/run_files.h"

namespace shoal::dds {

struct EndpointOptions {
  // Replaces cluster.json's host and domain: HOST, or the HOST:PORT that the run prints when it
  // starts. Empty: cluster.json's values are used.
  std::string peer;
  std::string interface;    // replaces config.json's transport.interface; empty: not replaced
  std::string secure = "";  // replaces cluster.json's folder of credentials; empty: not replaced
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
