// SPDX-License-Identifier: Apache-2.0
// How many env steps a second one host makes, computed from measured rows: the second table of
// docs/scale.md.
//
// C cores are divided among L learner threads, the replay server, which needs its load of
// scale_model.h, and actors, which take the rest:
//
//   t(L) = min((C - L - replay(t)) * actor_rate * kept, B * speed(L) / (update * S))
//
// with S samples per insert, batches of B, speed(L) the updates of L threads per update of one, and
// `kept` the share of N times one actor that N actors on N cores make. The split with most env
// steps counts.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "tests/benchmark/scale_model.h"

namespace shoal::bench {

// Updates a second of so many learner threads, in those of one.
class LearnerSpeed {
 public:
  // Reads a file of schema shoal-scaling-1: rows of network `compact` and batches of 128, the mean
  // of their efficiencies for each number of threads. Throws Error naming `source` otherwise.
  LearnerSpeed(std::string_view text, const std::string& source);
  explicit LearnerSpeed(std::map<int, double> times);

  // Linear between the numbers that were measured. More threads than those make no more updates.
  double Of(int threads) const;

 private:
  std::map<int, double> times_;
};

struct HostSplit {
  int learner_threads = 0;
  double actor_cores = 0, replay_cores = 0;
  double env_steps_per_second = 0;
};

// CHECK that there are 2 cores at least.
HostSplit BestSplit(const ScaleConstants& constants, const LearnerSpeed& speed, double kept,
                    int cores, double samples_per_insert);

// Markdown: the best split of 16, 32, 64 and 128 cores. `kept` is that of the reports' row "N
// actors of FetchReach with one 84x84 camera, fast, on N cores" with the largest N. Throws Error if
// there is none.
std::string HostTable(std::span<const Report> reports, const LearnerSpeed& speed);

}  // namespace shoal::bench
