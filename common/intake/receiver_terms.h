// SPDX-License-Identifier: Apache-2.0
// Intervals and time limits of a receiver of records (replay server or learner).
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace shoal {

// Smallest time between two messages with changed credits. Every actor receives each message, so
// changes are collected for this time.
inline constexpr std::chrono::milliseconds kCreditSpacing{20};
// Time between two messages with all credits.
inline constexpr std::chrono::seconds kCreditInterval{1};
// If there are more actors than this number, the spacing increases with the number of actors, so
// that at most 1,600 credits a second are sent.
inline constexpr int64_t kClosestActors = 32;

// Smallest time between two messages with changed credits for this number of actors.
inline std::chrono::milliseconds CreditSpacing(size_t actors) {
  const int64_t times = (static_cast<int64_t>(actors) + kClosestActors - 1) / kClosestActors;
  return std::min(kCreditSpacing * std::max<int64_t>(times, 1),
                  std::chrono::milliseconds(kCreditInterval) / 2);
}

// After the coordinator is lost, a receiver continues until nothing has arrived for this time.
inline constexpr std::chrono::seconds kFarewell{2};
// Longest time for which a receiver continues after the coordinator is lost.
inline constexpr std::chrono::seconds kFarewellLimit{20};

}  // namespace shoal
