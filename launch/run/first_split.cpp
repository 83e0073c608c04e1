// SPDX-License-Identifier: Apache-2.0
#include "launch/run/first_split.h"

#include <string>

#include "common/config/learner_threads.h"
#include "common/config/on_policy.h"
#include "common/nn/precision.h"
#include "learner/agent/update_cost.h"
#include "learner/learner_device.h"

namespace shoal::launch {
namespace {

// Time of an env step with inference and sending, as a multiple of physics and rendering.
constexpr double kActing = 1.1;
// Cost of evaluation and replay server per env step, in env steps (docs/performance.md, "Many
// actors").
constexpr double kServers = 0.4;

// GFLOP/s of an update on one core, from docs/performance.md for CPUs of each kind. Only the first
// division of the cores uses it; later ones use measurements.
double Speed(nn::Precision precision) {
  if (precision == nn::Precision::kBf16) return 150;
  const std::string isa = nn::CpuIsa();
  if (isa.starts_with("avx512")) return 90;
  return isa.starts_with("avx2") ? 40 : 15;
}

}  // namespace

std::optional<CoreCosts> ExpectedCosts(const RunConfig& run, double step_microseconds) {
  const Config& config = run.config;
  if (step_microseconds <= 0) return std::nullopt;
  const auto precision = nn::ChoosePrecision(config.learner.precision, config.observation.pixels);
  const double env_step = kActing * 1e-6 * step_microseconds;
  const double samples =
      config.replay.samples_per_insert.Mean(0, static_cast<uint64_t>(config.env_steps));
  return CoreCosts{.env_step = env_step,
                   .update = 1e-9 * learner::CostOfUpdate(config, run.spec).flop / Speed(precision),
                   .updates_per_env_step = samples / config.learner.batch,
                   .servers = kServers * env_step};
}

std::optional<SplitLimits> LimitsOfSplit(const Config& given, bool other_hosts, int cores) {
  const bool divides =
      (given.actors == 0 || given.learner.threads == 0) && !given.lockstep &&
      !LearnsOnPolicy(given) && given.observation.pixels && !other_hosts && cores >= kLeastCores &&
      !learner::UsesGpu(given.learner) &&
      given.replay.samples_per_insert.Mean(0, static_cast<uint64_t>(given.env_steps)) > 0;
  if (!divides) return std::nullopt;
  SplitLimits limits{.cores = cores, .most_threads = MostThreads(given)};
  if (given.actors > 0) limits.actors = given.actors;
  if (given.learner.threads > 0) limits.threads = given.learner.threads;
  return limits;
}

}  // namespace shoal::launch
