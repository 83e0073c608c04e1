// SPDX-License-Identifier: Apache-2.0
#include "common/config/sequences.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "common/base/error.h"
#include "common/config/algorithm_kind.h"

namespace shoal {
namespace {

bool HasHorizon(const AlgorithmKind& kind) { return kind.horizon != nullptr; }

}  // namespace

int HorizonOf(const Config& config) {
  const AlgorithmKind& kind = AlgorithmKindOf(config);
  return HasHorizon(kind) ? kind.horizon(config) : 0;
}

int SampleStepsOf(const Config& config) {
  return std::max(config.replay.n_step, HorizonOf(config));
}

std::string SampleStepsText(const Config& config) {
  const int horizon = HorizonOf(config);
  if (horizon > config.replay.n_step) return fmt::format("sequences of {} steps", horizon);
  return fmt::format("replay.n_step = {}", config.replay.n_step);
}

void ValidateSequences(const Config& config) {
  const Config usual;
  if (!HasHorizon(AlgorithmKindOf(config))) {
    if (config.network.state_hidden.empty()) return;
    throw UsageError(
        "network.state_hidden: learner.algorithm = {} has no latent state; expected it unset, or "
        "learner.algorithm = {}",
        config.learner.algorithm, AlgorithmsThat(HasHorizon));
  }
  const LearnerConfig& learner = config.learner;
  const std::pair<const char*, bool> unused[] = {
      {"learner.reward_scale", learner.reward_scale != usual.learner.reward_scale},
      {"learner.tau", learner.tau != usual.learner.tau},
      {"learner.average_rate", learner.average_rate != usual.learner.average_rate},
      {"learner.actor_period", learner.actor_period != usual.learner.actor_period},
      {"learner.target_period", learner.target_period != usual.learner.target_period},
      {"learner.bounded_targets", learner.bounded_targets},
      {"learner.normalise_vectors", learner.normalise_vectors},
      {"replay.copies", config.replay.copies != usual.replay.copies},
      {"network.blocks", config.network.blocks != usual.network.blocks}};
  for (const auto& [key, is_set] : unused) {
    if (!is_set) continue;
    throw UsageError("{}: learner.algorithm = {} does not use it; expected it unset", key,
                     learner.algorithm);
  }
  if (config.network.hidden.empty()) {
    throw UsageError(
        "network.hidden = []: the model of learner.algorithm = {} needs layers; expected for "
        "example [512, 512]",
        learner.algorithm);
  }
  if (!config.observation.pixels && config.network.state_hidden.empty()) {
    throw UsageError(
        "network.state_hidden = []: without observation.pixels, the latent state of "
        "learner.algorithm = {} needs layers; expected for example [512, 512, 512]",
        learner.algorithm);
  }
}

}  // namespace shoal
