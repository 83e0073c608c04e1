// SPDX-License-Identifier: Apache-2.0
// How a process reaches its run from another host, or by hand: what its options put in the place of
// the run folder's word.
#pragma once

#include <filesystem>
#include <string>

#include "common/config/config.h"
#include "common/config/run_files.h"

namespace shoal::dds {

struct Reach {
  // HOST, or HOST:PORT as the run shows it when it starts, instead of cluster.json's host and
  // domain; empty = as cluster.json says.
  std::string peer;
  std::string interface;    // instead of config.json's transport.interface; empty = as that says
  std::string secure = "";  // instead of cluster.json's folder of credentials; empty = as that says
};

// Where a process meets its run and through which interface of this host.
struct Place {
  ClusterAddress address;
  TransportConfig transport;
};

// The place that RUN/cluster.json and `transport` name, with `reach` applied. Throws Error; a
// malformed peer is a usage error.
Place FindPlace(const std::filesystem::path& run, const TransportConfig& transport,
                const Reach& reach);

}  // namespace shoal::dds
