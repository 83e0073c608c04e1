// SPDX-License-Identifier: Apache-2.0
#include "common/config/learner_threads.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/config/on_policy.h"
#include "common/config/sequences.h"

namespace shoal {
namespace {

// If a replica has fewer rows, work that does not shrink with the rows (moving targets, laying out
// weights) takes most of a replica's time.
constexpr int kLeastRows = 16;
// If a replica has fewer rows, such work takes nearly all of the time. At this number, 16 threads
// do 1.2 to 1.6 times what 8 do.
constexpr int kFewestRows = 8;

// Number of transitions in a batch, each with its copies.
int Groups(const Config& config) { return config.learner.batch / config.replay.copies; }

// Whether an update follows every `env_steps` env steps, on average over the run.
bool UpdatesEach(const Config& config, int env_steps) {
  const auto budget = static_cast<uint64_t>(config.env_steps);
  return config.replay.samples_per_insert.Mean(0, budget) * env_steps >= config.learner.batch;
}

int Half(int cores) { return std::max(1, cores / 2); }

// An update from pixels, or of sequences, takes as long as some tens of env steps, so actors wait
// for it. With an update for each step they wait nearly always. One for every eighth step takes
// three times as long as these steps.
int MostCores(const Config& config, int cores) {
  if (UpdatesEach(config, 1)) return cores;
  if (UpdatesEach(config, 8)) return (3 * cores + 3) / 4;
  return Half(cores);
}

}  // namespace

int MostThreads(const Config& config) {
  return std::max(1, std::min(config.learner.batch / kFewestRows, Groups(config)));
}

int LearnerThreads(const Config& config, int cores) {
  if (config.learner.threads > 0) return config.learner.threads;
  if (config.learner.device == "cuda") return 1;
  if (LearnsOnPolicy(config)) return Half(cores);
  if (!config.observation.pixels && HorizonOf(config) == 0) return 1;
  const int useful = std::max(1, config.learner.batch / kLeastRows);
  return std::min({MostCores(config, cores), useful, Groups(config)});
}

void CheckReplicas(const Config& config, int replicas) {
  const int groups = Groups(config);
  if (replicas <= groups) return;
  throw UsageError(
      "learner.threads = {}: expected at most learner.batch / replay.copies = {} / {} = {}: each "
      "thread learns from rows of its own, and the copies of a transition stay together",
      replicas, config.learner.batch, config.replay.copies, groups);
}

}  // namespace shoal
