// SPDX-License-Identifier: Apache-2.0
#include "common/dds/domain_xml.h"

#include <cstdlib>
#include <map>

#include "common/base/error.h"
#include "common/base/escape_markup.h"
#include "common/base/files.h"
#include "common/dds/host_network.h"
#include "common/dds/security_xml.h"
#include "common/link/run_topology.h"

namespace shoal::dds {
namespace {

// Fragments of 65 kB and the retransmission values carry megabyte samples at gigabytes per second;
// with Cyclone's defaults a 10 MB sample takes seconds. MaxSampleSize bounds the memory that one
// stray datagram makes a receiver allocate. A receive buffer is filled completely before the next
// one. With the megabyte of Cyclone's default, a thread that receives a kilobyte a second touches
// new memory for a quarter of an hour.
constexpr std::string_view kTemplate =
    R"(<CycloneDDS xmlns="https://cdds.io/config"><Domain id="any">
 <General>
  <Interfaces><NetworkInterface @INTERFACE@ multicast="false"/></Interfaces>
  <AllowMulticast>false</AllowMulticast>
  <MaxMessageSize>65500B</MaxMessageSize>
  <MaxRexmitMessageSize>65500B</MaxRexmitMessageSize>
  <FragmentSize>@FRAGMENT_BYTES@B</FragmentSize>
 </General>
 <Discovery>
  <Tag>@TAG@</Tag>
  <ParticipantIndex>@INDEX@</ParticipantIndex>
  <LeaseDuration>4 s</LeaseDuration>
  <SPDPInterval>1 s</SPDPInterval>
  @PEERS@
 </Discovery>
 <Sizing><ReceiveBufferSize>256KiB</ReceiveBufferSize></Sizing>
 <Internal>
  <SocketReceiveBufferSize max="16MB"/>
  <NackDelay>5ms</NackDelay>
  <MaxQueuedRexmitBytes>64MB</MaxQueuedRexmitBytes>
  <MaxQueuedRexmitMessages>4000</MaxQueuedRexmitMessages>
  <MaxSampleSize>64MB</MaxSampleSize>
  <BurstSize><MaxRexmit>2MB</MaxRexmit></BurstSize>
  @WATERMARKS@
 </Internal>
 @SECURITY@
</Domain></CycloneDDS>
)";

// A process announces itself to the other servers of the plane. The coordinator does not, because
// every process announces itself to the coordinator.
std::string PeersElement(const ClusterAddress& address, Role role, Plane plane) {
  std::string element = "<Peers>";
  for (const link::RunProcess& server : link::Servers()) {
    if (role == Role::kCoordinator || server.role == role || !link::Joins(server.role, plane)) {
      continue;
    }
    const int index = ParticipantIndex(server.role, server.index);
    element += fmt::format("<Peer Address=\"{}:{}\"/>", EscapeMarkup(address.host),
                           DiscoveryPort(PlaneDomain(address, plane), index));
  }
  return element + "</Peers>";
}

// If unacknowledged bytes reach "high", a write waits until they are below "low". A new writer
// begins with "high init" in place of "high".
std::string WatermarksElement(Role role) {
  const uint64_t bound = link::UnreadBytesBound(role);
  return fmt::format(
      "<Watermarks><WhcHigh>{}B</WhcHigh><WhcHighInit>{}B</WhcHighInit><WhcLow>{}B</WhcLow>"
      "</Watermarks>",
      bound, bound / 2, bound / 8);
}

bool IsPlaceholderName(std::string_view text) {
  return !text.empty() && text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_") == text.npos;
}

std::string Substitute(std::string_view xml,
                       const std::map<std::string_view, std::string>& values) {
  std::string filled;
  while (!xml.empty()) {
    const size_t begin = xml.find('@');
    filled += xml.substr(0, begin);
    if (begin == xml.npos) break;
    xml.remove_prefix(begin + 1);
    const std::string_view name = xml.substr(0, xml.find('@'));
    if (name.size() == xml.size() || !IsPlaceholderName(name)) {
      filled += '@';  // a literal @ of the text
      continue;
    }
    const auto value = values.find(name);
    if (value == values.end()) {
      throw UsageError("DDS configuration: unknown placeholder @{}@", name);
    }
    filled += value->second;
    xml.remove_prefix(name.size() + 1);
  }
  return filled;
}

}  // namespace

int ParticipantIndex(Role role, uint32_t index) {
  return link::FixedPort(role, index).value_or(-1);
}

int PlaneDomain(const ClusterAddress& address, Plane plane) {
  return plane == Plane::kMain ? address.domain : address.domain + 1;
}

std::string_view BuiltInTemplate() { return kTemplate; }

std::string DomainTemplate() {
  const char* path = std::getenv(kOverrideVariable);
  return path == nullptr || *path == '\0' ? std::string(kTemplate) : ReadFile(path);
}

std::string RenderDomainXml(std::string_view xml_template, const ClusterAddress& address,
                            const TransportConfig& transport, Role role, Plane plane) {
  const int index = ParticipantIndex(role);
  if (!address.secure.empty() && xml_template.find("@SECURITY@") == xml_template.npos) {
    throw UsageError("{}: the run is secured, but @SECURITY@ does not stand in the file",
                     kOverrideVariable);
  }
  const char* attribute = IsAddress(transport.interface) ? "address" : "name";
  return Substitute(
      xml_template,
      {{"INTERFACE", fmt::format("{}=\"{}\"", attribute, EscapeMarkup(transport.interface))},
       {"FRAGMENT_BYTES", std::to_string(transport.fragment_bytes)},
       {"TAG", plane == Plane::kOperate ? "" : EscapeMarkup(address.tag)},
       {"INDEX", index < 0 ? "none" : std::to_string(index)},
       {"PEERS", PeersElement(address, role, plane)},
       {"WATERMARKS", WatermarksElement(role)},
       {"SECURITY", SecurityElement(address.secure, role)}});
}

}  // namespace shoal::dds
