// SPDX-License-Identifier: Apache-2.0
// Time since the last message of another process, counted only while this process ran.
//
// If this process was stopped, swapped out or busy for long, unread messages may be waiting. One
// call of Look therefore counts at most kMostPerLook of the time since the previous call. The
// inactivity of this process does not count as silence of the other process.
#pragma once

#include <algorithm>
#include <chrono>

#include "common/base/clock.h"

namespace shoal {

// Not thread-safe. Call Look several times a second. Otherwise the timer counts too little silence.
class LivenessTimer {
 public:
  explicit LivenessTimer(SteadyTime start) : looked_(start) {}

  // Call this function when a message of the other process arrived.
  void Heard(SteadyTime now) {
    silent_ = SteadyTime::duration::zero();
    looked_ = now;
  }
  // Silence of the other process up to `now`.
  SteadyTime::duration Look(SteadyTime now) {
    silent_ +=
        std::clamp<SteadyTime::duration>(now - looked_, SteadyTime::duration::zero(), kMostPerLook);
    looked_ = now;
    return silent_;
  }

  static constexpr std::chrono::seconds kMostPerLook{1};

 private:
  SteadyTime looked_;
  SteadyTime::duration silent_{};
};

}  // namespace shoal
