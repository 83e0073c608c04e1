// SPDX-License-Identifier: Apache-2.0
// Divides the cores of a host between actors and learner threads at the beginning of a run.
// Measures the costs of an env step and an update, moves to the division that is fastest by these
// costs, measures again, and ends with the fastest measured division. Pure: the caller supplies
// counts and times.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "launch/watch/best_split.h"
#include "launch/watch/metrics_view.h"

namespace shoal::launch {

// The counts of a run's processes so far.
struct SplitCounts {
  double env_steps = 0, updates = 0;
  double actor_seconds = 0, actors_waited = 0;     // of all actors; waited: for the learner
  double learner_seconds = 0, learner_waited = 0;  // waited: for batches
  double servers_cpu_seconds = 0;                  // of replay server and evaluation actor
};
SplitCounts CountsOf(const MetricsView& view);

// One thread.
class CoreSplit {
 public:
  CoreSplit(const SplitLimits& limits, const Split& start) : limits_(limits), now_(start) {}

  struct Move {
    Split to;
    std::string line;  // for people
  };
  // Call about once a second. `seconds`: time of the run without pauses; `updates_per_env_step`:
  // the present target. The caller makes the returned move.
  std::optional<Move> Look(double seconds, const SplitCounts& counts, double updates_per_env_step);
  // Ends the search: Look proposes no more moves. Call when the user chooses the numbers.
  void Stop() { done_ = true; }
  bool done() const { return done_; }

  // kSettling: seconds before a measurement, in which the processes of a move start. kMeasured and
  // kLeastUpdates: least seconds and least updates of a measurement.
  static constexpr double kSettling = 2, kMeasured = 3;
  static constexpr double kLeastUpdates = 10;
  // Seconds after the first update at which an unfinished measurement is abandoned.
  static constexpr double kLast = 20;
  static constexpr size_t kMostMoves = 3;
  // Factors relative to the best env steps/s so far. kGain: least expected gain of a move. kLoss:
  // least gain of a move back to the best division.
  static constexpr double kGain = 1.08, kLoss = 1.05;

 private:
  struct Trial {
    Split split;
    double pace = 0;            // env steps/s that the updates allow
    double update_seconds = 0;  // time of an update, without the learner's waiting
  };

  std::optional<Move> Decide(const SplitCounts& counts, double updates_per_env_step, bool may_try);
  // The share that each further thread adds to an update, from the latest two trials with different
  // numbers of threads.
  double FurtherThread() const;
  bool Tried(const Split& split) const;

  const SplitLimits limits_;
  Split now_;
  std::vector<Trial> trials_;
  std::optional<double> first_update_;  // time of the first update, seconds of the run
  double settled_at_ = 0;
  std::optional<SplitCounts> before_;  // at the beginning of the measurement
  bool done_ = false;
};

}  // namespace shoal::launch
