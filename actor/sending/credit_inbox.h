// SPDX-License-Identifier: Apache-2.0
// The replay's newest credit for this actor session, passed from the DDS receive thread to the
// loop.
#pragma once

#include <chrono>
#include <optional>
#include <utility>

#include "common/base/clock.h"
#include "common/base/mutex.h"
#include "common/wire/messages.h"

namespace shoal::actor {

class CreditInbox {
 public:
  CreditInbox(uint32_t actor, uint64_t session) : actor_(actor), session_(session) {}

  // Called on the receive thread. Credits for other actors or sessions are ignored.
  void OnMessage(const CreditsMessage& message) {
    for (const Credit& credit : message.credits) {
      if (credit.actor != actor_ || credit.session != session_) continue;
      const MutexLock lock(mutex_);
      newest_ = credit;
      arrived_.NotifyAll();
    }
  }

  // Returns the newest credit if it has not been returned before. Waits for a credit until
  // `deadline`.
  std::optional<Credit> Take(SteadyTime deadline) {
    const MutexLock lock(mutex_);
    while (!newest_ && arrived_.WaitUntil(mutex_, deadline)) {
    }
    return std::exchange(newest_, std::nullopt);
  }

 private:
  const uint32_t actor_;
  const uint64_t session_;
  Mutex mutex_;
  ConditionVariable arrived_;
  std::optional<Credit> newest_ SHOAL_GUARDED_BY(mutex_);
};

}  // namespace shoal::actor
