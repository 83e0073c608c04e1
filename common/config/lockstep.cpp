// SPDX-License-Identifier: Apache-2.0
#include "common/config/lockstep.h"

#include <cmath>

#include "common/base/check.h"

namespace shoal {
namespace {

// Keeps a product such as 3 * (1 / 3.0) from being rounded down to one update less.
constexpr double kRoundingSlack = 1e-6;

uint64_t EnvStepsAtPhaseEnd(const Config& config, int64_t phase) {
  return static_cast<uint64_t>(LockstepVectorStepsAtPhaseEnd(config, phase) *
                               config.envs_per_actor);
}

// Mean over the phases 1 to `phase`.
double UpdatesPerPhase(const Config& config, int64_t phase) {
  const Schedule& samples = config.replay.samples_per_insert;
  if (samples.Most() <= 0) return 1;
  const double ratio =
      samples.Mean(EnvStepsAtPhaseEnd(config, 0), EnvStepsAtPhaseEnd(config, phase));
  return ratio * config.lockstep_steps * config.envs_per_actor / config.learner.batch;
}

int64_t LastPhase(const Config& config) {
  const int64_t envs = config.envs_per_actor;
  const int64_t vector_steps = (config.env_steps + envs - 1) / envs;
  const int64_t beyond = vector_steps - LockstepVectorStepsAtPhaseEnd(config, 0);
  const int64_t period = config.lockstep_steps;
  return beyond <= 0 ? 0 : (beyond + period - 1) / period;
}

}  // namespace

int64_t LockstepVectorStepsAtPhaseEnd(const Config& config, int64_t phase) {
  CHECK(phase >= 0) << phase;
  const int64_t envs = config.envs_per_actor;
  const int64_t period = config.lockstep_steps;
  const int64_t warm_up = (config.replay.min_size + envs - 1) / envs;
  return (warm_up + period - 1) / period * period + phase * period;
}

uint64_t LockstepUpdatesAtPhaseEnd(const Config& config, int64_t phase) {
  CHECK(phase >= 0) << phase;
  const double updates = static_cast<double>(phase) * UpdatesPerPhase(config, phase);
  return static_cast<uint64_t>(std::floor(updates + kRoundingSlack));
}

uint64_t LockstepStepsBeforeUpdate(const Config& config, uint64_t update) {
  CHECK(update >= 1);
  // The first phase that ends with at least `update` updates is above `low` and at most `high`.
  int64_t low = 0, high = 1;
  while (LockstepUpdatesAtPhaseEnd(config, high) < update) {
    low = high;
    high *= 2;
  }
  while (high - low > 1) {
    const int64_t middle = low + (high - low) / 2;
    (LockstepUpdatesAtPhaseEnd(config, middle) < update ? low : high) = middle;
  }
  return EnvStepsAtPhaseEnd(config, high);
}

uint64_t LockstepEnvSteps(const Config& config) {
  return EnvStepsAtPhaseEnd(config, LastPhase(config));
}

uint64_t LockstepLastUpdate(const Config& config) {
  return LockstepUpdatesAtPhaseEnd(config, LastPhase(config));
}

}  // namespace shoal
