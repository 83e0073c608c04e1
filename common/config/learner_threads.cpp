#include "common/config/learner_threads.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/config/on_policy.h"

namespace shoal {
namespace {

// Transitions of a batch, each with its copies.
int Groups(const Config& config) { return config.learner.batch / config.replay.copies; }

// The largest number up to `most` >= 1 that divides `groups`.
int LargestDivisor(int groups, int most) {
  int divisor = std::min(groups, most);
  while (groups % divisor != 0) --divisor;
  return divisor;
}

}  // namespace

int LearnerThreads(const Config& config, int cores) {
  if (config.learner.threads > 0) return config.learner.threads;
  const int half = std::max(1, cores / 2);
  return LearnsOnPolicy(config) ? half : LargestDivisor(Groups(config), half);
}

void CheckReplicas(const Config& config, int replicas) {
  const int groups = Groups(config);
  if (groups % replicas == 0) return;
  int more = std::min(replicas, groups);
  while (groups % more != 0) ++more;
  throw UsageError(
      "learner.threads = {}: expected a divisor of learner.batch / replay.copies = {} / {} = {}, "
      "such as {} or {}: each thread learns from an equal part of the batch",
      replicas, config.learner.batch, config.replay.copies, groups,
      LargestDivisor(groups, replicas), more);
}

}  // namespace shoal
