// SPDX-License-Identifier: Apache-2.0
// The link between the roles of a run that are threads of one process (hub.h has the contract).
//
// In addition to the contract:
// - Writers and readers match when they are made. A sample is copied only once for all its readers;
//   payloads start at a multiple of 64 bytes.
// - Callbacks run on the receive threads of the reader's hub, one per plane, and never on the
//   writing thread. The readers of a plane take turns, one sample each.
// - A writer's bound of unread bytes is UnreadBytesBound of its role (role.h). A sample above the
//   bound is accepted if nothing else is unread. A sample is unread until each matched reader's
//   callback has returned; WaitForAcks waits for the same event.
// - Samples written before a writer is destroyed still reach its readers.
// - If the process dies, all its roles end. Therefore only Abandon ends the liveness of one role.
#pragma once

#include <atomic>
#include <memory>
#include <utility>

#include "common/link/hub.h"
#include "common/link/local_exchange.h"

namespace shoal::link {

// Connects the hubs of one run and owns their shared state. Any thread.
class LocalNetwork {
 public:
  // `choose`: in simulations, selects the topic that a receive thread reads next if several topics
  // have samples. Null: the topics take turns.
  explicit LocalNetwork(LocalExchange::Choice choose = nullptr) : exchange_(std::move(choose)) {}
  // The hubs must be destroyed before the network.
  ~LocalNetwork();
  LocalNetwork(const LocalNetwork&) = delete;
  LocalNetwork& operator=(const LocalNetwork&) = delete;

  // Makes a hub for one instance of the role. A restarted instance joins again. The hub borrows the
  // network.
  std::unique_ptr<Hub> Join(Role role);

  // Simulates the death of the hub's process, for tests and simulations. The hub's writers and
  // readers are unmatched, and its readers receive no more callbacks. Afterwards, the hub's writers
  // and readers can only be destroyed.
  void Abandon(const Hub& hub);
  // These functions simulate a network partition that is longer than kLivenessLimit. Disconnect
  // unmatches the hub's writers and readers; Reconnect matches them again as if they were new.
  // Samples in between are lost, except the history of topics with late joiners, which is sent
  // again after Reconnect.
  void Disconnect(const Hub& hub);
  void Reconnect(const Hub& hub);

 private:
  LocalExchange exchange_;
  std::atomic<int> hubs_{0};
};

}  // namespace shoal::link
