// The replay's newest word to this actor session, handed from the DDS receive thread to the loop.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>

#include "common/base/clock.h"
#include "common/wire/messages.h"

namespace shoal::actor {

class CreditInbox {
 public:
  CreditInbox(uint32_t actor, uint64_t session) : actor_(actor), session_(session) {}

  // Receive thread. Words to others are ignored.
  void OnMessage(const Credit& credit) {
    if (credit.actor != actor_ || credit.session != session_) return;
    const std::lock_guard lock(mutex_);
    newest_ = credit;
    arrived_.notify_all();
  }

  // The newest word not taken before; waits for one until `deadline`.
  std::optional<Credit> Take(SteadyTime deadline) {
    std::unique_lock lock(mutex_);
    arrived_.wait_until(lock, deadline, [&] { return newest_.has_value(); });
    return std::exchange(newest_, std::nullopt);
  }

 private:
  const uint32_t actor_;
  const uint64_t session_;
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::optional<Credit> newest_;
};

}  // namespace shoal::actor
