// SPDX-License-Identifier: Apache-2.0
// Recent growth of a count per second, for display. Records arrive in chunks, so a one-second rate
// would jump between 0 and a whole chunk.
#pragma once

#include <deque>
#include <optional>

namespace shoal::launch {

// One thread.
class RecentRate {
 public:
  static constexpr double kWindowSeconds = 30;
  static constexpr double kLeastSeconds = 3;  // shortest interval for a rate

  explicit RecentRate(double window_seconds = kWindowSeconds, double least_seconds = kLeastSeconds)
      : window_seconds_(window_seconds), least_seconds_(least_seconds) {}

  // Adds the count at time `seconds`, which must be later than the previous time. Returns the
  // growth per second over the window; empty until least_seconds are covered. If the count has
  // become smaller (a learner that continues from a checkpoint), the window starts again.
  std::optional<double> Add(double seconds, double count);

 private:
  struct Seen {
    double seconds, count;
  };
  double window_seconds_, least_seconds_;
  std::deque<Seen> seen_;
};

}  // namespace shoal::launch
