// SPDX-License-Identifier: Apache-2.0
#include "common/config/exploration_kind.h"

#include "common/base/check.h"
#include "common/config/algorithm_kind.h"
#include "common/config/on_policy.h"

namespace shoal {

bool LearnsDeviation(const Config& config) { return AlgorithmKindOf(config).squashed_gaussian; }

ExplorationKind ExplorationKindOf(const Config& config) {
  const std::string& kind = config.exploration.kind;
  if (kind == "gaussian") return ExplorationKind::kGaussian;
  if (kind == "ou") return ExplorationKind::kOrnsteinUhlenbeck;
  if (kind == "squashed_gaussian") return ExplorationKind::kSquashedGaussian;
  CHECK(kind == "auto") << kind;
  if (LearnsOnPolicy(config)) return ExplorationKind::kPolicy;
  return LearnsDeviation(config) ? ExplorationKind::kSquashedGaussian : ExplorationKind::kGaussian;
}

const Schedule& ExplorationSigma(const Config& config) {
  const auto own_noise = AlgorithmKindOf(config).own_noise;
  return own_noise != nullptr ? own_noise(config) : config.exploration.sigma;
}

std::string_view NameOf(ExplorationKind kind) {
  switch (kind) {
    case ExplorationKind::kSquashedGaussian:
      return "squashed_gaussian";
    case ExplorationKind::kGaussian:
      return "gaussian";
    case ExplorationKind::kOrnsteinUhlenbeck:
      return "ou";
    case ExplorationKind::kPolicy:
      return "policy";
  }
  CHECK(false) << "an exploration without a name";
  return "";
}

}  // namespace shoal
