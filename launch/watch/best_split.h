// SPDX-License-Identifier: Apache-2.0
// Computes the best division of a host's cores between actors and learner threads from the costs of
// an env step and an update. Pure.
//
//   u(N) = N / (c (1 + w (N - 1)))            updates/s of N threads
//   pace(A, N) = min(A / a, u(N) / p)         env steps/s
//   N + pace (a + s) <= cores
//
// A: actors; N: learner threads; a: seconds of one actor per env step; c: seconds of one thread per
// update; w: share of c that each further thread adds; p: updates per env step; s: core seconds of
// replay server and evaluation actor per env step.
#pragma once

#include <optional>

namespace shoal::launch {

struct Split {
  int actors = 0, threads = 0;  // threads: of the learner
  bool operator==(const Split&) const = default;
};

struct CoreCosts {
  double env_step = 0, update = 0;
  double updates_per_env_step = 0;
  double servers = 0;
  double further_thread = kFurtherThread;

  // Value measured with 8 threads (docs/performance.md, "Threads of the learner").
  static constexpr double kFurtherThread = 0.03;
};

struct SplitLimits {
  int cores = 1;
  int most_threads = 1;             // largest number of threads that each get rows of a batch
  std::optional<int> actors = {};   // if given, the number is fixed
  std::optional<int> threads = {};  // if given, the number is fixed
};

double UpdatesPerSecond(const CoreCosts& costs, int threads);
// Env steps/s.
double PaceOf(const CoreCosts& costs, const Split& split);
// Returns the fastest division in which each learner thread has its own core. A further thread is
// used only if it multiplies the pace by at least kWorth. There are at most kHeadroom times as many
// actors as keep the learner busy. If there are too few cores, the result is one thread and one
// actor, unless these numbers are given.
Split BestSplit(const CoreCosts& costs, const SplitLimits& limits);

inline constexpr double kWorth = 1.01, kHeadroom = 1.15;

}  // namespace shoal::launch
