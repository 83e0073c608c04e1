#include "common/wire/control_state.h"

namespace shoal {

void ControlState::OnMessage(const ControlMessage& message, SteadyTime now) {
  const MutexLock lock(mutex_);
  silence_.Heard(now);
  heard_ = true;
  if (message.epoch < epoch_) return;
  epoch_ = message.epoch;
  state_ = message.state;
}

RunState ControlState::state() const {
  const MutexLock lock(mutex_);
  return state_;
}

bool ControlState::CoordinatorLost(SteadyTime now) {
  const MutexLock lock(mutex_);
  return silence_.Look(now) > (heard_ ? kLease : kFirstLease);
}

}  // namespace shoal
