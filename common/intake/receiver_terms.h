// SPDX-License-Identifier: Apache-2.0
// The terms on which a process receives records, whoever it is: replay server or learner.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "common/base/clock.h"

namespace shoal {

// Each word about credit goes to every actor, so that words are collected for a moment ...
inline constexpr std::chrono::milliseconds kCreditSpacing{20};
// ... and between repetitions of every credit.
inline constexpr std::chrono::seconds kCreditInterval{1};
// With more actors than this the moment grows with their number: 1,600 words a second reach actors,
// however many they are.
inline constexpr int64_t kClosestActors = 32;

inline std::chrono::milliseconds CreditSpacing(size_t actors) {
  const int64_t times = (static_cast<int64_t>(actors) + kClosestActors - 1) / kClosestActors;
  return std::min(kCreditSpacing * std::max<int64_t>(times, 1),
                  std::chrono::milliseconds(kCreditInterval) / 2);
}

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
