// SPDX-License-Identifier: Apache-2.0
// The coordinator's last request, and whether the coordinator still runs. A receive thread of the
// link writes this state, and the main loop of the process reads it.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/clock.h"
#include "common/base/liveness_timer.h"
#include "common/base/mutex.h"
#include "common/wire/messages.h"

namespace shoal {

class ControlState {
 public:
  // `start`: time from which the process waits for the first heartbeat.
  explicit ControlState(SteadyTime start) : liveness_(start) {}

  // Stores the request of a message, unless its epoch is older than the newest epoch so far. Any
  // thread.
  void OnMessage(const ControlMessage& message, SteadyTime now);

  RunState state() const;
  // The present value of a configuration key if it was changed in this run; else empty.
  std::optional<double> Setting(std::string_view key) const;
  // The present value of the key if it was changed in this run; else `configured`.
  double SettingOr(std::string_view key, double configured) const {
    return Setting(key).value_or(configured);
  }
  // Whether the coordinator is lost, because no heartbeat arrived for kLease (before the first
  // heartbeat: for kFirstLease). Call this function several times a second, because time in which
  // this process did not run is not counted.
  bool CoordinatorLost(SteadyTime now);

  // Long enough for a coordinator that was stopped for ten seconds to send a heartbeat again.
  static constexpr std::chrono::seconds kLease{15};
  static constexpr std::chrono::seconds kFirstLease{30};

 private:
  mutable Mutex mutex_;
  LivenessTimer liveness_ SHOAL_GUARDED_BY(mutex_);
  bool heard_ SHOAL_GUARDED_BY(mutex_) = false;
  uint64_t epoch_ SHOAL_GUARDED_BY(mutex_) = 0;
  RunState state_ SHOAL_GUARDED_BY(mutex_) = RunState::kRunning;
  std::vector<std::string> setting_names_ SHOAL_GUARDED_BY(mutex_);
  std::vector<double> setting_values_ SHOAL_GUARDED_BY(mutex_);
};

}  // namespace shoal
