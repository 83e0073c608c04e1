// One process's place on the run's DDS domains: star discovery, unicast, no multicast.
//
// Coordinator, learner and replay sit at fixed participant indices (0, 1, 2); actors have none and
// know the servers as peers. The transitions, weights, metrics and control topics live in domain D,
// the batch topics in D+1, so that a slow batch reader cannot block the rest.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/config/config.h"
#include "common/config/run_files.h"

namespace shoal::dds {

enum class Role { kCoordinator, kLearner, kReplay, kActor };

// Which of the two domains a topic lives in.
enum class Plane { kMain, kBatch };

// Sets malloc options that keep megabyte samples out of mmap (facts: 5x throughput). Call first in
// main, before threads.
void TuneMalloc();

class Bus {
 public:
  // Joins the run's domains. Throws Error naming the port when another process holds the role's index
  // or the interface does not exist.
  Bus(const ClusterAddress& address, const TransportConfig& transport, Role role);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  // Implementation access for publisher.h / subscriber.h. Internal.
  struct Impl;
  Impl& impl() { return *impl_; }

 private:
  std::unique_ptr<Impl> impl_;
};

// A free even domain below 100, claimed by joining as its coordinator; tries the next one while the
// port is taken. `address` gets domain and tag. Throws Error when none is free.
std::unique_ptr<Bus> ClaimDomain(const TransportConfig& transport, ClusterAddress* address);

}  // namespace shoal::dds
