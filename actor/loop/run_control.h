// SPDX-License-Identifier: Apache-2.0
// The reasons for which an actor's loop ends.
#pragma once

#include "common/base/clock.h"
#include "common/wire/messages.h"

namespace shoal::actor {

class RunControl {
 public:
  virtual ~RunControl() = default;
  // The run's state, as in the coordinator's last message.
  virtual RunState state() = 0;
  // True if the coordinator has been silent for longer than its lease. Call CoordinatorLost several
  // times a second.
  virtual bool CoordinatorLost(SteadyTime now) = 0;
  // True once a signal has asked this process to stop.
  virtual bool StopRequested() = 0;
  // How many such signals have come. Another signal while the actor waits for its last records to
  // be stored ends this wait.
  virtual int StopRequests() = 0;
};

}  // namespace shoal::actor
