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
#include <map>
#include <memory>
#include <string>

#include "common/config/config.h"
#include "common/config/run_files.h"
#include "common/dds/reach.h"

namespace shoal::dds {

// kActor: a training actor. kEval: the evaluation actor. kClient: a program that watches or steers
// a run from outside.
enum class Role { kCoordinator, kLearner, kReplay, kActor, kEval, kClient };

// kMain: domain D. kBatch: domain D+1. kOperate: domain D+1 without a tag.
enum class Plane { kMain, kBatch, kOperate };

// Sets malloc options that keep megabyte samples out of mmap, whose page faults would be most of a
// receiver's time. Call first in main, before threads.
void TuneMalloc();

class Bus {
 public:
  // Joins the run's domains that the role has to do with. At most one Bus per domain and process.
  // Throws Error naming the port when another process holds the role's index, the interface when it
  // does not exist, the host when it does not resolve. transport.interface "auto" is the interface
  // by which the kernel reaches the address's host.
  //
  // The environment variable SHOAL_DDS_XML names a file that replaces the built-in Cyclone DDS
  // configuration; docs/wire_format.md lists the placeholders it may use.
  Bus(const ClusterAddress& address, const TransportConfig& transport, Role role);
  Bus(const Place& place, Role role) : Bus(place.address, place.transport, role) {}
  // Publishers and subscribers of the bus must be gone.
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  // Messages that could not be read, by topic, since the bus was made; every topic that a
  // subscriber read at some time. Any thread.
  std::map<std::string, uint64_t> Malformed() const;

  // Implementation access for publisher.h / subscriber.h. Internal.
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
