// SPDX-License-Identifier: Apache-2.0
// Recent rates of a run, its remaining time and its use of time, for users. One-second rates are
// noisy and averages since the start lag behind; these are 30-second averages.
#pragma once

#include <deque>
#include <optional>

#include "launch/watch/recent_rate.h"
#include "launch/watch/run_totals.h"

namespace shoal::launch {

// Counts of a run at one moment.
struct RunMoment {
  double seconds = 0;  // time of the run so far; never falls
  double env_steps = 0;
  std::optional<double> updates;  // empty: the learner has not reported
};

// One thread.
class RecentRun {
 public:
  // Call it about once a second.
  void Add(const RunMoment& moment, RunTotals totals);
  // Drops all counts and starts again kSettling later. Call it after a change that makes earlier
  // counts useless, such as a pause.
  void Forget(double seconds);

  // Rates over the last 30 s; empty until RecentRate::kLeastSeconds are covered.
  std::optional<double> env_steps_per_second() const { return env_steps_per_second_; }
  std::optional<double> updates_per_second() const { return updates_per_second_; }
  // Remaining time at the pace of the last two minutes. Empty before the first update and in the
  // first seconds after this update, because a run without updates is many times faster.
  std::optional<double> SecondsLeft(double env_steps, double budget) const;
  // Counts of the last 30 s, or of the known part of that interval.
  RunTotals Totals() const;

  static constexpr double kSettling = 3;  // seconds in which reports that span a pause arrive

 private:
  struct Counted {
    double seconds = 0;
    RunTotals totals;
  };

  RecentRate env_steps_, updates_;
  RecentRate pace_{120, 10};  // env steps, since the first update
  std::optional<double> env_steps_per_second_, updates_per_second_, steady_pace_;
  bool learned_ = false;  // the learner has made an update
  std::deque<Counted> counted_;
  double from_ = 0;  // earlier moments are ignored
};

}  // namespace shoal::launch
