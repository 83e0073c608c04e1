// SPDX-License-Identifier: Apache-2.0
// The coordinator's last request, and whether the coordinator still runs. Written by a receive
// thread of the link, read by the process's loop.
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
  // `start`: when waiting for the first heartbeat began.
  explicit ControlState(SteadyTime start) : liveness_(start) {}

  // Any thread. Older epochs than the newest seen are ignored.
  void OnMessage(const ControlMessage& message, SteadyTime now);

  RunState state() const;
  // The present value of a configuration key, where it was changed in this run.
  std::optional<double> Setting(std::string_view key) const;
  // The same, else `configured`.
  double SettingOr(std::string_view key, double configured) const {
    return Setting(key).value_or(configured);
  }
  // No heartbeat for kLease (kFirstLease before the first one): the coordinator is gone. To be
  // asked several times a second: time in which this process itself did not run is not counted.
  bool CoordinatorLost(SteadyTime now);

  // Longer than a coordinator stopped for ten seconds needs to be heard again.
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
