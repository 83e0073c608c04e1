// SPDX-License-Identifier: Apache-2.0
// What tells an actor's loop to end.
#pragma once

#include "common/base/clock.h"
#include "common/wire/messages.h"

namespace shoal::actor {

class RunControl {
 public:
  virtual ~RunControl() = default;
  // The run's state as the coordinator said it last.
  virtual RunState state() = 0;
  // The coordinator has been silent for longer than its lease. To be asked several times a second.
  virtual bool CoordinatorLost(SteadyTime now) = 0;
  // A signal asked this process to stop; and how many times one did, for those who ask twice.
  virtual bool StopRequested() = 0;
  virtual int StopRequests() = 0;
};

}  // namespace shoal::actor
