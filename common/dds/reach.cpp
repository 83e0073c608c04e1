// SPDX-License-Identifier: Apache-2.0
#include "common/dds/reach.h"

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

Place FindPlace(const std::filesystem::path& run, const TransportConfig& transport,
                const Reach& reach) {
  Place place{ReadClusterAddress(run), transport};
  if (!reach.peer.empty()) ApplyPeer(reach.peer, &place.address);
  if (!reach.interface.empty()) place.transport.interface = reach.interface;
  if (!reach.secure.empty()) place.address.secure = reach.secure;
  return place;
}

}  // namespace shoal::dds
