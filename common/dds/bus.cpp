// SPDX-License-Identifier: Apache-2.0
#include "common/dds/bus.h"

#include <charconv>
#include <utility>

#include "common/base/error.h"
#include "common/dds/dds_log.h"
#include "common/dds/domain_xml.h"
#include "common/dds/host_network.h"
#include "common/dds/steady_waits.h"
// clang-format off
#include "common/dds/bus_impl.h"
// clang-format on

namespace shoal::dds {
namespace {

constexpr size_t kMaxTagBytes = 255;

// `transport` with "auto" replaced by an interface's name.
TransportConfig ResolveInterface(const ClusterAddress& address, TransportConfig transport) {
  if (transport.interface == "auto") transport.interface = InterfaceTowards(address.host);
  return transport;
}

void CheckAddress(const ClusterAddress& address, const TransportConfig& transport, Role role) {
  if (address.domain < 0 || address.domain > 98 || address.domain % 2 != 0) {
    throw UsageError("DDS domain {}: expected an even number from 0 to 98", address.domain);
  }
  if (role != Role::kClient && (address.tag.empty() || address.tag.size() > kMaxTagBytes)) {
    throw UsageError("DDS tag \"{}\": expected 1 to {} characters", address.tag, kMaxTagBytes);
  }
  if (!HostResolves(address.host)) {
    throw RuntimeError("host \"{}\" of the run does not resolve to an IPv4 address", address.host);
  }
  const std::string& interface = transport.interface;
  if (interface == "auto") return;
  const bool exists = IsAddress(interface) ? HostHasAddress(interface) : InterfaceExists(interface);
  if (!exists) {
    throw RuntimeError("transport.interface \"{}\" does not exist on this host, which has {}",
                       interface, InterfaceNames());
  }
}

void ThrowJoinError(int domain, Role role, const std::string& reason) {
  const int index = ParticipantIndex(role);
  if (index >= 0) {
    for (const int port : {DiscoveryPort(domain, index), DiscoveryPort(domain, index) + 1}) {
      if (UdpPortFree(port)) continue;
      throw PortTakenError(RuntimeError(
          "UDP port {} is taken: another process is the {} of DDS domain {} on this host", port,
          link::RoleName(role), domain));
    }
  }
  throw RuntimeError("cannot join DDS domain {} as {}: {}", domain, link::RoleName(role), reason);
}

void Join(const std::string& xml_template, const ClusterAddress& address,
          const TransportConfig& transport, Role role, Plane plane, Entity* domain,
          Entity* participant) {
  const int id = PlaneDomain(address, plane);
  const std::string xml = RenderDomainXml(xml_template, address, transport, role, plane);
  const DdsErrorCapture capture;
  const dds_entity_t domain_handle =
      dds_create_domain(static_cast<dds_domainid_t>(id), xml.c_str());
  if (domain_handle == DDS_RETCODE_PRECONDITION_NOT_MET) {
    throw RuntimeError("this process has joined DDS domain {} already", id);
  }
  if (domain_handle < 0) ThrowJoinError(id, role, capture.text());
  Entity joined(domain_handle, "a domain");
  const dds_entity_t handle =
      dds_create_participant(static_cast<dds_domainid_t>(id), nullptr, nullptr);
  if (handle < 0) {
    joined = {};  // otherwise this process's own domain would hold the ports
    ThrowJoinError(id, role, capture.text());
  }
  *domain = std::move(joined);
  *participant = Entity(handle, "a participant");
}

}  // namespace

Bus::Bus(const ClusterAddress& address, const TransportConfig& asked, Role role)
    : impl_(std::make_unique<Impl>()) {
  CheckAddress(address, asked, role);
  const TransportConfig transport = ResolveInterface(address, asked);
  RouteDdsLog();
  RequireSteadyWaits();
  const std::string xml = DomainTemplate();
  if (role != Role::kClient) {
    Join(xml, address, transport, role, Plane::kMain, &impl_->main_domain,
         &impl_->main_participant);
  }
  if (role == Role::kLearner || role == Role::kReplay) {
    Join(xml, address, transport, role, Plane::kBatch, &impl_->batch_domain,
         &impl_->batch_participant);
  }
  if (role == Role::kCoordinator || role == Role::kClient) {
    Join(xml, address, transport, role, Plane::kOperate, &impl_->operate_domain,
         &impl_->operate_participant);
  }
}

Bus::~Bus() = default;

std::map<std::string, uint64_t> Bus::Malformed() const {
  const MutexLock lock(impl_->mutex);
  std::map<std::string, uint64_t> counts;
  for (const auto& [topic, counter] : impl_->malformed) counts[topic] = *counter;
  return counts;
}

int OperatePort(const ClusterAddress& address) {
  return DiscoveryPort(PlaneDomain(address, Plane::kOperate), ParticipantIndex(Role::kCoordinator));
}

ClusterAddress ParsePeer(const std::string& peer) {
  const size_t colon = peer.rfind(':');
  ClusterAddress address;
  int port = 0;
  if (colon != std::string::npos && colon > 0) {
    const char* end = peer.data() + peer.size();
    const auto [stop, error] = std::from_chars(peer.data() + colon + 1, end, port);
    if (error != std::errc() || stop != end) port = 0;
  }
  for (address.domain = 0; address.domain <= 98; address.domain += 2) {
    if (OperatePort(address) != port) continue;
    address.host = peer.substr(0, colon);
    return address;
  }
  throw UsageError(
      "peer \"{}\": expected HOST:PORT as the run shows them when it starts, with port {} + 500 n",
      peer, OperatePort(ClusterAddress()));
}

}  // namespace shoal::dds
