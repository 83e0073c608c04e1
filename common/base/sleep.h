// SPDX-License-Identifier: Apache-2.0
// Sleeps on the clock of the simulation, if there is one (scheduler.h). The code of a role must not
// sleep in another way.
#pragma once

#include <thread>

#include "common/base/clock.h"
#include "common/base/scheduler.h"

namespace shoal {

inline void SleepUntil(SteadyTime time) {
  if (Scheduler* scheduler = Scheduler::Current()) return scheduler->SleepUntil(time);
  std::this_thread::sleep_until(time);
}

template <class Rep, class Period>
void SleepFor(std::chrono::duration<Rep, Period> span) {
  SleepUntil(Now() + std::chrono::duration_cast<SteadyTime::duration>(span));
}

}  // namespace shoal
