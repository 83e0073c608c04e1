// SPDX-License-Identifier: Apache-2.0
// Connects one process to the DDS domains of its run. Discovery is by configured peers; all
// messages are unicast.
//
// Coordinator, learner and replay have fixed participant indices (0, 1, 2). Actors have no fixed
// index; their configured peers are the servers. Domain D carries the topics of records,
// weights, metrics and control. Domain D+1 carries the batch topics, so that a slow batch reader
// cannot block the other topics. Learner and replay join the two domains. The coordinator also
// joins D+1, for its clients, which only have the coordinator's address. There the coordinator does
// not use the run's tag, so that it does not discover the learner and the replay.
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

// Sets malloc options so that malloc does not use mmap for samples of several megabytes. The page
// faults of mmap would take most of a receiver's time. Call this function first in main, before
// other threads exist.
void TuneMalloc();

// The link between processes (common/link/hub.h has the contract).
class Bus final : public link::Hub {
 public:
  // Joins the domains of the run that the role uses. A process has at most one Bus in each domain.
  // If transport.interface is "auto", the Bus uses the interface by which the kernel reaches the
  // address's host. Throws Error
  //   - naming the port, if another process has the role's index,
  //   - naming the interface, if the interface does not exist,
  //   - naming the host, if the host name does not resolve.
  //
  // The environment variable SHOAL_DDS_XML may name a file that replaces the built-in Cyclone DDS
  // configuration; docs/wire_format.md lists the placeholders that the file may use.
  Bus(const ClusterAddress& address, const TransportConfig& transport, Role role);
  Bus(const RunEndpoint& endpoint, Role role) : Bus(endpoint.address, endpoint.transport, role) {}
  // Writers and readers of the bus must be destroyed before the bus.
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

// Claims a free even domain in 2..98 by joining the domain as its coordinator. The search starts at
// a random domain, and goes on to the next domain if one of the run's fixed ports is taken. Sets
// the domain of `address` and, if the tag of `address` is empty, a tag that no other run has. The
// other processes contact the coordinator at the host in `address`. Throws Error if no domain is
// free.
std::unique_ptr<Bus> ClaimDomain(const TransportConfig& transport, ClusterAddress* address);

// UDP port at which clients find the coordinator of a run.
int OperatePort(const ClusterAddress& address);
// The address, without a tag, at which a client reaches the coordinator at `peer`, "HOST:PORT".
// Throws Error (kUsage) if `peer` does not have this form or if a coordinator cannot have this
// port.
ClusterAddress ParsePeer(const std::string& peer);
// IP address of the interface of this host that has the route to `host`. Throws Error if the name
// does not resolve or no route exists.
std::string InterfaceTowards(const std::string& host);

}  // namespace shoal::dds
