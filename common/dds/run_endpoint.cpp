// SPDX-License-Identifier: Apache-2.0
#include "common/dds/run_endpoint.h"

#include "common/dds/bus.h"

namespace shoal::dds {
namespace {

void ApplyPeer(const std::string& peer, ClusterAddress* address) {
  if (peer.find(':') == std::string::npos) {
    address->host = peer;
    return;
  }
  const ClusterAddress given = ParsePeer(peer);
  address->host = given.host;
  address->domain = given.domain;
}

}  // namespace

RunEndpoint FindEndpoint(const std::filesystem::path& run, const TransportConfig& transport,
                         const EndpointOptions& options) {
  RunEndpoint endpoint{ReadClusterAddress(run), transport};
  if (!options.peer.empty()) ApplyPeer(options.peer, &endpoint.address);
  if (!options.interface.empty()) endpoint.transport.interface = options.interface;
  if (!options.secure.empty()) endpoint.address.secure = options.secure;
  return endpoint;
}

}  // namespace shoal::dds
