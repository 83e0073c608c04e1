// SPDX-License-Identifier: Apache-2.0
// How fast a count has grown lately, for people: the rate of the last second alone jumps between 0
// and a chunk's worth where records come in chunks.
#pragma once

#include <deque>
#include <optional>

namespace shoal::launch {

// One thread.
class RecentRate {
 public:
  static constexpr double kWindowSeconds = 30;
  static constexpr double kLeastSeconds = 3;  // for a rate to mean anything

  explicit RecentRate(double window_seconds = kWindowSeconds, double least_seconds = kLeastSeconds)
      : window_seconds_(window_seconds), least_seconds_(least_seconds) {}

  // The count at a time; times grow. Afterwards the growth per second over the window, empty while
  // too little of it is known. A count that has become smaller, as that of a learner that went on
  // from a checkpoint, begins anew.
  std::optional<double> Add(double seconds, double count);

 private:
  struct Seen {
    double seconds, count;
  };
  double window_seconds_, least_seconds_;
  std::deque<Seen> seen_;
};

}  // namespace shoal::launch
