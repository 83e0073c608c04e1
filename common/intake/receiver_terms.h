// The terms on which a process receives records, whoever it is: replay server or learner.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>

#include "common/base/clock.h"

namespace shoal {

// Each word about credit goes to every actor, so that with many of them words are collected for a
// moment: then what a transition costs does not grow with their number.
inline constexpr std::chrono::milliseconds kCreditSpacing{20};
// Between repetitions of every credit.
inline constexpr std::chrono::seconds kCreditInterval{1};
// When the coordinator is gone a receiver stays until nothing has come for so long, ...
inline constexpr std::chrono::seconds kFarewell{2};
// ... but no longer than this.
inline constexpr std::chrono::seconds kFarewellLimit{20};
// How far beyond this host's clock that of an actor may be.
inline constexpr std::chrono::minutes kClockMargin{10};

// No actor session that has begun by now has a higher number.
inline uint64_t LatestSession() {
  return static_cast<uint64_t>(
      std::max<int64_t>(0, WallTimeNs() + std::chrono::nanoseconds(kClockMargin).count()));
}

}  // namespace shoal
