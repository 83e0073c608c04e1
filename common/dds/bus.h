// SPDX-License-Identifier: Apache-2.0
// One process's place on the run's DDS domains: star discovery, unicast, no multicast.
//
// Coordinator, learner and replay sit at fixed participant indices (0, 1, 2); actors have none and
// know the servers as peers. The transitions, weights, metrics and control topics live in domain D,
// the batch topics in D+1, so that a slow batch reader cannot block the rest; learner and replay
// join D+1. So does the coordinator, there without the run's tag, so that it and these two do not
// see each other: it shows the run to, and takes orders from, clients that know nothing but its
// address.
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
  // Joins the run's domains that the role has to do with. At most one Bus per domain and process.
  // Throws Error naming the port when another process holds the role's index, the interface when it
  // does not exist, the host when it does not resolve. transport.interface "auto" is the interface
  // by which the kernel reaches the address's host.
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

// A free even domain in 2..98, claimed by joining as its coordinator. Starts at a random one and
// tries the next while one of the run's fixed ports is taken. `address` gets the domain and, when
// its tag is empty, a tag that no other run has; its host is where the other processes look for
// this one. Throws Error when none is free.
std::unique_ptr<Bus> ClaimDomain(const TransportConfig& transport, ClusterAddress* address);

// UDP port at which clients find the coordinator of a run.
int OperatePort(const ClusterAddress& address);
// The address of a run whose coordinator is found at "HOST:PORT", for clients: without a tag.
// Throws Error (kUsage) when it is not of that form or no coordinator uses the port.
ClusterAddress ParsePeer(const std::string& peer);
// The interface of this host, by its address, from which `host` is reached. Throws Error when the
// name does not resolve or there is no way.
std::string InterfaceTowards(const std::string& host);

}  // namespace shoal::dds
