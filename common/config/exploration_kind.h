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

// The kind of exploration.kind. `auto` depends on the run's algorithm: a stochastic policy explores
// by its own Gaussian, a deterministic one by Gaussian noise.
ExplorationKind ExplorationKindOf(const Config& config);

// The word for exploration.kind; "policy" for kPolicy, which no key names.
std::string_view NameOf(ExplorationKind kind);

}  // namespace shoal
