// SPDX-License-Identifier: Apache-2.0
#include "common/config/algorithm_kind.h"

#include <algorithm>
#include <iterator>

#include "common/base/check.h"

namespace shoal {
namespace {

constexpr AlgorithmKind kKinds[] = {
    {.name = "sac",
     .squashed_gaussian = true,
     .encoder_options = true,
     .priorities = true,
     .own_section = "sac."},
    {.name = "td3", .priorities = true, .own_section = "td3."},
    {.name = "ddpg", .priorities = true},
    {.name = "drqv2",
     .priorities = true,
     .own_section = "drqv2.",
     .own_noise = [](const Config& config) -> const Schedule& { return config.drqv2.noise; }},
    {.name = "mrq",
     .priorities = true,
     .own_section = "mrq.",
     .horizon = [](const Config& config) { return config.mrq.horizon; }},
    {.name = "ppo", .on_policy = true, .own_section = "ppo."},
};

}  // namespace

std::span<const AlgorithmKind> AlgorithmKinds() { return kKinds; }

const AlgorithmKind& AlgorithmKindOf(const Config& config) {
  const auto kind = std::ranges::find(kKinds, config.learner.algorithm, &AlgorithmKind::name);
  CHECK(kind != std::end(kKinds)) << config.learner.algorithm;
  return *kind;
}

std::string AlgorithmsThat(bool (*fits)(const AlgorithmKind& kind)) {
  std::string names;
  for (const AlgorithmKind& kind : kKinds) {
    if (!fits(kind)) continue;
    if (!names.empty()) names += " | ";
    names += kind.name;
  }
  return names;
}

}  // namespace shoal
