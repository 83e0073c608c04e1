// SPDX-License-Identifier: Apache-2.0
// The terms on which a receiver of records, replay server or learner, serves its actors.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace shoal {

// Each word about credit goes to every actor, so that words are collected for a moment ...
inline constexpr std::chrono::milliseconds kCreditSpacing{20};
// ... and between repetitions of every credit.
inline constexpr std::chrono::seconds kCreditInterval{1};
// Beyond this number of actors the interval grows with it: at most 1,600 credits a second are sent,
// for any number of actors.
inline constexpr int64_t kClosestActors = 32;

inline std::chrono::milliseconds CreditSpacing(size_t actors) {
  const int64_t times = (static_cast<int64_t>(actors) + kClosestActors - 1) / kClosestActors;
  return std::min(kCreditSpacing * std::max<int64_t>(times, 1),
                  std::chrono::milliseconds(kCreditInterval) / 2);
}

// After the coordinator is lost, a receiver stays until nothing has arrived for this time, ...
inline constexpr std::chrono::seconds kFarewell{2};
// ... but no longer than this.
inline constexpr std::chrono::seconds kFarewellLimit{20};

}  // namespace shoal
