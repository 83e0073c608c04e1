// SPDX-License-Identifier: Apache-2.0
#include "common/wire/control_state.h"

namespace shoal {

void ControlState::OnMessage(const ControlMessage& message, SteadyTime now) {
  const MutexLock lock(mutex_);
  liveness_.Heard(now);
  heard_ = true;
  if (message.epoch < epoch_) return;
  epoch_ = message.epoch;
  state_ = message.state;
  setting_names_ = message.setting_names;
  setting_values_ = message.setting_values;
}

RunState ControlState::state() const {
  const MutexLock lock(mutex_);
  return state_;
}

std::optional<double> ControlState::Setting(std::string_view key) const {
  const MutexLock lock(mutex_);
  for (size_t i = 0; i < setting_names_.size() && i < setting_values_.size(); ++i) {
    if (setting_names_[i] == key) return setting_values_[i];
  }
  return std::nullopt;
}

bool ControlState::CoordinatorLost(SteadyTime now) {
  const MutexLock lock(mutex_);
  return liveness_.Look(now) > (heard_ ? kLease : kFirstLease);
}

}  // namespace shoal
