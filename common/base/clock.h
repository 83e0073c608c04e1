// SPDX-License-Identifier: Apache-2.0
// Clocks. Deadlines use the steady clock; records and files carry wall time.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace shoal {

using SteadyTime = std::chrono::steady_clock::time_point;

inline SteadyTime Now() { return std::chrono::steady_clock::now(); }

inline double SecondsSince(SteadyTime start) {
  return std::chrono::duration<double>(Now() - start).count();
}

// Nanoseconds since 1970 (UTC), from the wall clock: may jump.
inline int64_t WallTimeNs() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

inline double WallTimeSeconds() { return static_cast<double>(WallTimeNs()) * 1e-9; }

// "2026-01-31T12:00:00Z"
std::string UtcTimestamp();

}  // namespace shoal
