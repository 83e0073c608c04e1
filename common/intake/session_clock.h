// SPDX-License-Identifier: Apache-2.0
// Upper bound of the session numbers (common/config/session_number.h) that a receiver of records
// accepts. A session number is the wall-clock time of the actor at its start, and the newest
// session supersedes the others. A number from the far future would therefore exclude the true
// actor. If the clock is set back, the bound stays, because actors that started before the change
// have larger numbers.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

namespace shoal {

// Accepted lead of an actor's clock over this host's clock.
inline constexpr std::chrono::minutes kClockMargin{10};

// Not thread-safe; one owner.
class SessionClock {
 public:
  // `own_session`: the receiver's session, which is higher than earlier sessions of the receiver.
  explicit SessionClock(uint64_t own_session) : highest_(own_session) {}

  // Highest number that a session may have at the time `wall_time_ns`.
  uint64_t Latest(int64_t wall_time_ns) {
    highest_ = std::max(highest_, static_cast<uint64_t>(std::max<int64_t>(0, wall_time_ns)));
    return highest_ + static_cast<uint64_t>(std::chrono::nanoseconds(kClockMargin).count());
  }

 private:
  uint64_t highest_;  // maximum of the receiver's session and of all clock readings so far
};

}  // namespace shoal
