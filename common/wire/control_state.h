// What the coordinator last asked for, and whether it is still there. Written by a DDS receive
// thread, read by the process's loop.
#pragma once

#include <chrono>
#include <mutex>

#include "common/base/clock.h"
#include "common/wire/messages.h"

namespace shoal {

class ControlState {
 public:
  // `start`: when waiting for the first heartbeat began.
  explicit ControlState(SteadyTime start) : last_heard_(start) {}

  // Any thread. Older epochs than the newest seen are ignored.
  void OnMessage(const ControlMessage& message, SteadyTime now);

  RunState state() const;
  // No heartbeat for kLease (kFirstLease before the first one): the coordinator is gone.
  bool CoordinatorLost(SteadyTime now) const;

  static constexpr std::chrono::seconds kLease{10};
  static constexpr std::chrono::seconds kFirstLease{30};

 private:
  mutable std::mutex mutex_;
  SteadyTime last_heard_;
  bool heard_ = false;
  uint64_t epoch_ = 0;
  RunState state_ = RunState::kRunning;
};

}  // namespace shoal
