// SPDX-License-Identifier: Apache-2.0
// How long nothing was heard of somebody, as far as this process was there to hear it.
//
// A process that was itself stopped, swapped out or busy for long finds an old "last heard" when it
// comes back; the news lie unread meanwhile. So a look counts at most kMostPerLook of the time
// since the last look: own absence is never held against the other side.
#pragma once

#include <algorithm>
#include <chrono>

#include "common/base/clock.h"

namespace shoal {

// Not thread-safe. Look several times a second, else silence is counted short.
class LivenessTimer {
 public:
  explicit LivenessTimer(SteadyTime start) : looked_(start) {}

  void Heard(SteadyTime now) {
    silent_ = SteadyTime::duration::zero();
    looked_ = now;
  }
  // LivenessTimer up to `now`.
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
