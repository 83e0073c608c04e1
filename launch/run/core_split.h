// SPDX-License-Identifier: Apache-2.0
// Divides the cores of a host between actors and learner threads while a run is young: measures
// what an env step and an update cost, moves to the division that these costs promise most of,
// measures again, and ends with the best division that it has measured. Pure: counts and times in,
// moves out.
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
  double actor_seconds = 0, actors_waited = 0;     // of all actors; waited for the learner
  double learner_seconds = 0, learner_waited = 0;  // waited for batches
  double servers_cpu_seconds = 0;                  // of replay server and evaluation
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
  // Call about once a second with the seconds of the run, pauses left out. `updates_per_env_step`:
  // that are asked for now. The caller makes the move.
  std::optional<Move> Look(double seconds, const SplitCounts& counts, double updates_per_env_step);
  // Keeps still from now on: the numbers are decided elsewhere.
  void Stop() { done_ = true; }
  bool done() const { return done_; }

  // A division is measured for at least so long, so many updates, once the processes that a move
  // concerns have started.
  static constexpr double kSettling = 2, kMeasured = 3;
  static constexpr double kLeastUpdates = 10;
  // After the first update; a measurement that is not finished by then is given up.
  static constexpr double kLast = 20;
  static constexpr size_t kMostMoves = 3;
  // Factors of the env steps/s measured best so far: to be worth a move; to be worth the way back.
  static constexpr double kGain = 1.08, kLoss = 1.05;

 private:
  struct Trial {
    Split split;
    double pace = 0;            // env steps/s, as the updates allow them
    double update_seconds = 0;  // while the learner did not wait
  };

  std::optional<Move> Decide(const SplitCounts& counts, double updates_per_env_step, bool may_try);
  // The share that each further thread adds to an update, by the latest two trials of different
  // numbers.
  double FurtherThread() const;
  bool Tried(const Split& split) const;

  const SplitLimits limits_;
  Split now_;
  std::vector<Trial> trials_;
  std::optional<double> first_update_;  // seconds of the run
  double settled_at_ = 0;
  std::optional<SplitCounts> before_;  // at the beginning of the measurement
  bool done_ = false;
};

}  // namespace shoal::launch
