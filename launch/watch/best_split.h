// SPDX-License-Identifier: Apache-2.0
// How the cores of a host are best divided between the actors and the threads of the learner, by
// what an env step and an update cost. Pure.
//
//   u(N) = N / (c (1 + w (N - 1)))            updates/s of N threads
//   pace(A, N) = min(A / a, u(N) / p)         env steps/s
//   N + pace (a + s) <= cores
//
// a: an env step, in seconds of an actor; c: an update, in seconds of one thread; w: what each
// further thread adds to that; p: updates per env step; s: what replay server and evaluation take
// per env step, in seconds of a core.
#pragma once

#include <optional>

namespace shoal::launch {

struct Split {
  int actors = 0, threads = 0;  // of the learner
  bool operator==(const Split&) const = default;
};

struct CoreCosts {
  double env_step = 0, update = 0;
  double updates_per_env_step = 0;
  double servers = 0;
  double further_thread = kFurtherThread;

  // Measured with 8 threads (docs/performance.md, "Threads of the learner").
  static constexpr double kFurtherThread = 0.03;
};

struct SplitLimits {
  int cores = 1;
  int most_threads = 1;             // that have rows of a batch
  std::optional<int> actors = {};   // given: stays
  std::optional<int> threads = {};  // given: stays
};

double UpdatesPerSecond(const CoreCosts& costs, int threads);
// Env steps/s.
double PaceOf(const CoreCosts& costs, const Split& split);
// The fastest division in which the threads have cores of their own. More threads must gain kWorth
// each. Actors beyond those that keep the learner busy (and kHeadroom) are left out. Nothing fits
// where there are too few cores: then one thread, and one actor, unless their numbers are given.
Split BestSplit(const CoreCosts& costs, const SplitLimits& limits);

inline constexpr double kWorth = 1.01, kHeadroom = 1.15;

}  // namespace shoal::launch
