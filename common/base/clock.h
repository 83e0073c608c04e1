// SPDX-License-Identifier: Apache-2.0
// Clocks. A simulation replaces both clocks (scheduler.h). Deadlines use the steady clock. Records
// and files use wall time.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "common/base/scheduler.h"
#include "common/base/steady_time.h"

namespace shoal {

inline SteadyTime Now() {
  if (Scheduler* scheduler = Scheduler::Current()) return scheduler->Now();
  return std::chrono::steady_clock::now();
}

inline double SecondsSince(SteadyTime start) {
  return std::chrono::duration<double>(Now() - start).count();
}

// Nanoseconds since 1970 (UTC), from the wall clock, which may jump.
inline int64_t WallTimeNs() {
  if (Scheduler* scheduler = Scheduler::Current()) return scheduler->WallTimeNs();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

inline double WallTimeSeconds() { return static_cast<double>(WallTimeNs()) * 1e-9; }

// The present time as text: "2026-01-31T12:00:00Z".
std::string UtcTimestamp();

}  // namespace shoal
