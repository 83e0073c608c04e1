// SPDX-License-Identifier: Apache-2.0
// The bound on session numbers (common/config/session_number.h) that a receiver of records accepts.
// A session is the wall clock of its actor at its start, and the newest supersedes the others, so
// that a number from the far future would shut the true actor out. A clock that is set back does
// not lower the bound: actors that started before the change have larger numbers.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace shoal {

// How far beyond this host's clock that of an actor may be.
inline constexpr std::chrono::minutes kClockMargin{10};

// One owner.
class SessionClock {
 public:
  // `own_session`: the receiver's, which is never below those of its predecessors.
  explicit SessionClock(uint64_t own_session) : highest_(own_session) {}

  // No session that has begun by now has a higher number.
  uint64_t Latest(int64_t wall_time_ns) {
    highest_ = std::max(highest_, static_cast<uint64_t>(std::max<int64_t>(0, wall_time_ns)));
    return highest_ + static_cast<uint64_t>(std::chrono::nanoseconds(kClockMargin).count());
  }

 private:
  uint64_t highest_;  // of the own session and of the clock at each look
};

}  // namespace shoal
