// SPDX-License-Identifier: Apache-2.0
// Connects one process to the DDS domains of its run: star discovery, unicast, no multicast.
//
// Coordinator, learner and replay have fixed participant indices (0, 1, 2). Actors have no fixed
// index; the servers are their configured peers. Domain D carries the topics of transitions,
// weights, metrics and control. Domain D+1 carries the batch topics, so that a slow batch reader
// cannot block the other topics; learner and replay join both domains. The coordinator joins D+1
// for its clients, which know only its address. It joins D+1 without the run's tag, so that it does
// not discover the learner and the replay there.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "common/config/config.h"
#include "common/config/run_files.h"
#include "common/dds/run_endpoint.h"
#include "common/link/hub.h"

namespace shoal::dds {

using link::Plane;
using link::Role;

// Sets malloc options that keep megabyte samples out of mmap, whose page faults would be most of a
// receiver's time. Call first in main, before threads.
void TuneMalloc();

// The link between processes (common/link/hub.h has the contract).
class Bus final : public link::Hub {
 public:
  // Joins the domains of the run that the role uses. A process has at most one Bus per domain.
  // Throws Error naming the port when another process holds the role's index, the interface when
  // the interface does not exist, or the host when the host name does not resolve. If
  // transport.interface is "auto", the Bus uses the interface by which the kernel reaches the
  // address's host.
  //
  // The environment variable SHOAL_DDS_XML names a file that replaces the built-in Cyclone DDS
  // configuration; docs/wire_format.md lists the placeholders it may use.
  Bus(const ClusterAddress& address, const TransportConfig& transport, Role role);
  Bus(const RunEndpoint& endpoint, Role role) : Bus(endpoint.address, endpoint.transport, role) {}
  // Writers and readers of the bus must be gone.
  ~Bus() override;
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  std::map<std::string, uint64_t> Malformed() const override;
#define SHOAL_BUS_ENDS(message, ...)                                                         \
  std::unique_ptr<link::WriterEnd<message>> MakeWriter(link::MessageType<message>) override; \
  std::unique_ptr<link::ReaderEnd> MakeReader(link::MessageType<message>,                    \
                                              std::function<void(const message&)>) override;
  SHOAL_MESSAGES(SHOAL_BUS_ENDS)
#undef SHOAL_BUS_ENDS

  // Access for writer.cpp and reader.cpp. Internal.
  struct Impl;
  Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

// Claims a free even domain in 2..98 by joining it as its coordinator. The search starts at a
// random domain and tries the next one while one of the run's fixed ports is taken. `address`
// receives the domain and, when its tag is empty, a tag that no other run has. The other processes
// look for this one at the host in `address`. Throws Error when no domain is free.
std::unique_ptr<Bus> ClaimDomain(const TransportConfig& transport, ClusterAddress* address);

// UDP port at which clients find the coordinator of a run.
int OperatePort(const ClusterAddress& address);
// The address, without a tag, at which a client reaches the coordinator at `peer`, "HOST:PORT".
// Throws Error (kUsage) when `peer` does not have this form or no coordinator can use the port.
ClusterAddress ParsePeer(const std::string& peer);
// IP address of the interface of this host that leads to `host`. Throws Error when the name does
// not resolve or no route exists.
std::string InterfaceTowards(const std::string& host);

}  // namespace shoal::dds
