// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/best_split.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"

namespace shoal::launch {
namespace {

// The number of actors that keeps this number of learner threads busy, at most the cores that the
// threads leave free.
int ActorsFor(const CoreCosts& costs, const SplitLimits& limits, int threads) {
  if (limits.actors) return *limits.actors;
  const double busy =
      UpdatesPerSecond(costs, threads) / costs.updates_per_env_step * costs.env_step;
  return std::clamp(static_cast<int>(std::ceil(kHeadroom * busy)), 1,
                    std::max(1, limits.cores - threads));
}

}  // namespace

double UpdatesPerSecond(const CoreCosts& costs, int threads) {
  return threads / (costs.update * (1 + costs.further_thread * (threads - 1)));
}

double PaceOf(const CoreCosts& costs, const Split& split) {
  return std::min(split.actors / costs.env_step,
                  UpdatesPerSecond(costs, split.threads) / costs.updates_per_env_step);
}

Split BestSplit(const CoreCosts& costs, const SplitLimits& limits) {
  CHECK(costs.env_step > 0 && costs.update > 0 && costs.updates_per_env_step > 0);
  const int least = limits.threads.value_or(1);
  const int most = limits.threads.value_or(std::min(limits.cores, limits.most_threads));
  Split best{.actors = ActorsFor(costs, limits, least), .threads = least};
  double best_pace = 0;
  for (int threads = least; threads <= most; ++threads) {
    const Split split{.actors = ActorsFor(costs, limits, threads), .threads = threads};
    const double pace = PaceOf(costs, split);
    if (threads + pace * (costs.env_step + costs.servers) > limits.cores) continue;
    if (pace < kWorth * best_pace) continue;
    best = split;
    best_pace = pace;
  }
  return best;
}

}  // namespace shoal::launch
