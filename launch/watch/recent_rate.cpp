// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/recent_rate.h"

namespace shoal::launch {

std::optional<double> RecentRate::Add(double seconds, double count) {
  if (!seen_.empty() && (count < seen_.back().count || seconds < seen_.back().seconds)) {
    seen_.clear();
  }
  seen_.push_back({seconds, count});
  // Keeps the last sample before the window, so that the samples span the whole window.
  while (seen_.size() > 2 && seconds - seen_[1].seconds >= window_seconds_) seen_.pop_front();
  const double span = seconds - seen_.front().seconds;
  if (span < least_seconds_) return std::nullopt;
  return (count - seen_.front().count) / span;
}

}  // namespace shoal::launch
