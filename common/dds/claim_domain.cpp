// SPDX-License-Identifier: Apache-2.0
#include "common/dds/claim_domain.h"

#include <unistd.h>

#include <random>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/dds/bus.h"
#include "common/dds/domain_xml.h"
#include "common/dds/host_network.h"
#include "common/link/run_topology.h"
// clang-format off
#include "common/dds/bus_impl.h"
// clang-format on

namespace shoal::dds {
namespace {

constexpr int kFirstDomain = 2, kLastDomain = 98;
constexpr int kDomains = (kLastDomain - kFirstDomain) / 2 + 1;

}  // namespace

bool RunPortsFree(int domain) {
  ClusterAddress address;
  address.domain = domain;
  for (const Plane plane : {Plane::kMain, Plane::kBatch}) {
    for (const link::RunProcess& server : link::Servers()) {
      const int port =
          DiscoveryPort(PlaneDomain(address, plane), ParticipantIndex(server.role, server.index));
      if (!UdpPortFree(port) || !UdpPortFree(port + 1)) return false;
    }
  }
  return true;
}

std::unique_ptr<Bus> ClaimDomain(const TransportConfig& transport, ClusterAddress* address) {
  ClusterAddress claim = *address;
  if (claim.tag.empty()) claim.tag = fmt::format("shoal-{:x}-{}", WallTimeNs(), getpid());
  std::random_device random;
  const int first = static_cast<int>(random() % kDomains);
  for (int i = 0; i < kDomains; ++i) {
    claim.domain = kFirstDomain + 2 * ((first + i) % kDomains);
    if (!RunPortsFree(claim.domain)) continue;
    try {
      auto bus = std::make_unique<Bus>(claim, transport, Role::kCoordinator);
      *address = claim;
      return bus;
    } catch (const PortTakenError&) {
      // Another run took the domain between the check and the join.
    }
  }
  const link::RunProcess& last = link::Servers().back();
  throw RuntimeError("all {} DDS domains from {} to {} are taken on this host (UDP ports {} to {})",
                     kDomains, kFirstDomain, kLastDomain, DiscoveryPort(kFirstDomain, 0),
                     DiscoveryPort(kLastDomain + 1, ParticipantIndex(last.role, last.index)) + 1);
}

}  // namespace shoal::dds
