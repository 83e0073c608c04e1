// SPDX-License-Identifier: Apache-2.0
// Kind of exploration of a run's actors.
#pragma once

#include <string_view>

#include "common/config/config.h"

namespace shoal {

// kPolicy: the unsquashed Gaussian of an on-policy algorithm.
enum class ExplorationKind { kSquashedGaussian, kGaussian, kOrnsteinUhlenbeck, kPolicy };

// Whether the run's algorithm learns a Gaussian policy that is squashed by tanh. The policy of an
// on-policy algorithm is an unsquashed Gaussian; all other policies are deterministic.
bool LearnsDeviation(const Config& config);

// The kind that exploration.kind selects. `auto` depends on the run's algorithm: a stochastic
// policy explores by its own Gaussian, a deterministic policy by Gaussian noise.
ExplorationKind ExplorationKindOf(const Config& config);

// Standard deviation of gaussian and ou noise: the algorithm's own, else exploration.sigma.
const Schedule& ExplorationSigma(const Config& config);

// The value of the key exploration.kind that selects `kind`. "policy" for kPolicy, which the key
// cannot select.
std::string_view NameOf(ExplorationKind kind);

}  // namespace shoal
