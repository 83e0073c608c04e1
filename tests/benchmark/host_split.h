// SPDX-License-Identifier: Apache-2.0
// Env steps per second of one host, computed from measured rows: the second table of docs/scale.md.
//
// C cores are divided among L learner threads, the replay server (with the load of scale_model.h)
// and actors, which use the rest:
//
//   t(L) = min((C - L - replay(t)) * actor_rate * kept, B * speed(L) / (update * S))
//
// t(L): env steps per second. S: samples per insert. B: batch size. speed(L): updates of L threads
// per update of one thread. `kept`: rate of N actors on N cores as a share of N times the rate of
// one actor. The split with the most env steps is chosen.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "tests/benchmark/scale_model.h"

namespace shoal::bench {

// Updates per second of a number of learner threads, relative to one thread.
class LearnerSpeed {
 public:
  // Reads rows of network `compact` with batches of 128 from a file of schema shoal-scaling-1 and
  // averages their efficiencies for each number of threads. Throws Error naming `source`.
  LearnerSpeed(std::string_view text, const std::string& source);
  explicit LearnerSpeed(std::map<int, double> times);

  // Interpolates linearly between measured numbers of threads. Above the largest measured number
  // the speed is constant.
  double Of(int threads) const;

 private:
  std::map<int, double> times_;
};

struct HostSplit {
  int learner_threads = 0;
  double actor_cores = 0, replay_cores = 0;
  double env_steps_per_second = 0;
};

// CHECKs that there are at least 2 cores.
HostSplit BestSplit(const ScaleConstants& constants, const LearnerSpeed& speed, double kept,
                    int cores, double samples_per_insert);

// Markdown: the best split of 16, 32, 64 and 128 cores. `kept` is taken from the row "N actors of
// FetchReach with one 84x84 camera, fast, on N cores" with the largest N. Throws Error if the
// reports have no such row.
std::string HostTable(std::span<const Report> reports, const LearnerSpeed& speed);

}  // namespace shoal::bench
