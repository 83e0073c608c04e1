// SPDX-License-Identifier: Apache-2.0
// How a run's actors explore.
#pragma once

#include <string_view>

#include "common/config/config.h"

namespace shoal {

// kPolicy: the unsquashed Gaussian of an on-policy algorithm.
enum class ExplorationKind { kSquashedGaussian, kGaussian, kOrnsteinUhlenbeck, kPolicy };

// Whether the run's algorithm learns a Gaussian policy that is squashed by tanh; that of on-policy
// algorithms is not squashed, the others' are deterministic.
bool LearnsDeviation(const Config& config);

// What exploration.kind says; `auto` is what the run's algorithm wants: its own Gaussian, or
// Gaussian noise beside a deterministic policy.
ExplorationKind ExplorationKindOf(const Config& config);

// As exploration.kind has it; of kPolicy, which no key names, "policy".
std::string_view NameOf(ExplorationKind kind);

}  // namespace shoal
