// SPDX-License-Identifier: Apache-2.0
// The link between the roles of a run that are threads of one process (hub.h has the contract).
//
// Beyond the contract:
// - Writers and readers match when they are made. A sample is copied once, whatever the number of
//   its readers; payloads start at a multiple of 64 bytes.
// - Callbacks run on the receive threads of the reader's hub, one per plane, and never on the
//   writing thread. The readers of a plane take turns, one sample each.
// - A writer's bound of unread bytes is UnreadBytesBound of its role (role.h); a sample above it is
//   taken when nothing else is unread. Unread is a sample until each matched reader's callback has
//   returned; WaitForAcks waits for the same.
// - What a writer had written when it was destroyed still reaches its readers.
// - A process that dies takes all its roles with it: liveness is lost by Abandon alone.
#pragma once

#include <atomic>
#include <memory>
#include <utility>

#include "common/link/hub.h"
#include "common/link/local_exchange.h"

namespace shoal::link {

// Connects the hubs of one run. Owns what they share. Any thread.
class LocalNetwork {
 public:
  // `choose`: which of several topics that have samples for a receive thread it reads next, for
  // simulations; null: they take turns.
  explicit LocalNetwork(LocalExchange::Choice choose = nullptr) : exchange_(std::move(choose)) {}
  // The hubs must be gone.
  ~LocalNetwork();
  LocalNetwork(const LocalNetwork&) = delete;
  LocalNetwork& operator=(const LocalNetwork&) = delete;

  // A hub for an instance of the role; one that is restarted joins anew. The hub borrows the
  // network.
  std::unique_ptr<Hub> Join(Role role);

  // Does what the death of the hub's process would do, for tests and simulations: its writers and
  // readers are unmatched, and its readers are not called back any more. They may only be
  // destroyed.
  void Abandon(const Hub& hub);
  // Does what a partition longer than kLivenessLimit does to the hub's process, and its end: its
  // writers and readers are unmatched, then matched again as new ones. In between their samples are
  // lost, but for the history of topics with late joiners, which is then sent again.
  void Disconnect(const Hub& hub);
  void Reconnect(const Hub& hub);

 private:
  LocalExchange exchange_;
  std::atomic<int> hubs_{0};
};

}  // namespace shoal::link
