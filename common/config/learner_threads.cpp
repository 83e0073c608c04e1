#include "common/config/learner_threads.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/config/on_policy.h"

namespace shoal {
namespace {

// Below, what does not shrink with the rows (steps of the optimiser, weights in the layouts of the
// CPU) takes most of a replica's time, and each holds parameters of its own.
constexpr int kLeastRows = 16;

// Transitions of a batch, each with its copies.
int Groups(const Config& config) { return config.learner.batch / config.replay.copies; }

// An update of pixels takes the time of some tens of env steps: where there is one for so many of
// them or fewer, actors leave half of the cores idle or more.
constexpr int kFewSteps = 8;

bool ActorsMostlyWait(const Config& config) {
  return config.replay.samples_per_insert * kFewSteps >= config.learner.batch;
}

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
  if (LearnsOnPolicy(config)) return half;
  if (!config.observation.pixels) return 1;
  const int most = ActorsMostlyWait(config) ? cores : half;
  const int useful = std::max(1, config.learner.batch / kLeastRows);
  return LargestDivisor(Groups(config), std::min(most, useful));
}

void CheckReplicas(const Config& config, int replicas) {
  const int groups = Groups(config);
  if (groups % replicas == 0) return;
  const int fewer = LargestDivisor(groups, replicas);
  int more = replicas;
  while (more < groups && groups % more != 0) ++more;
  throw UsageError(
      "learner.threads = {}: expected a divisor of learner.batch / replay.copies = {} / {} = {}, "
      "such as {}: each thread learns from an equal part of the batch",
      replicas, config.learner.batch, config.replay.copies, groups,
      more > groups ? fmt::format("{}", fewer) : fmt::format("{} or {}", fewer, more));
}

}  // namespace shoal
