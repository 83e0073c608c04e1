// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/recent_run.h"

#include <utility>

namespace shoal::launch {

void RecentRun::Add(const RunMoment& moment, RunTotals totals) {
  if (moment.seconds < from_) return;
  env_steps_per_second_ = env_steps_.Add(moment.seconds, moment.env_steps);
  if (moment.updates) updates_per_second_ = updates_.Add(moment.seconds, *moment.updates);
  learned_ = learned_ || moment.updates.value_or(0) > 0;
  if (learned_) steady_pace_ = pace_.Add(moment.seconds, moment.env_steps);
  counted_.push_back({moment.seconds, std::move(totals)});
  // Keeps the last sample before the window, so that the samples span the whole window.
  const auto covers = [&] {
    return moment.seconds - counted_[1].seconds >= RecentRate::kWindowSeconds;
  };
  while (counted_.size() > 2 && covers()) counted_.pop_front();
}

void RecentRun::Forget(double seconds) {
  *this = RecentRun();
  from_ = seconds + kSettling;
}

std::optional<double> RecentRun::SecondsLeft(double env_steps, double budget) const {
  if (env_steps >= budget) return 0;
  if (!steady_pace_ || *steady_pace_ <= 0) return std::nullopt;
  return (budget - env_steps) / *steady_pace_;
}

RunTotals RecentRun::Totals() const {
  if (counted_.empty()) return {};
  if (counted_.size() == 1) return counted_.front().totals;
  return Since(counted_.front().totals, counted_.back().totals);
}

}  // namespace shoal::launch
