// SPDX-License-Identifier: Apache-2.0
// Time since the last message of another process, counted only while this process ran.
//
// If this process was stopped, swapped out or busy for long, unread messages may be waiting. So one
// poll counts at most kMostPerLook of the time since the last poll: the absence of the observer
// does not count as silence of the other process.
#pragma once

#include <algorithm>
#include <chrono>

#include "common/base/clock.h"

namespace shoal {

// Not thread-safe. Call Look several times a second; otherwise the timer counts too little silence.
class LivenessTimer {
 public:
  explicit LivenessTimer(SteadyTime start) : looked_(start) {}

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
