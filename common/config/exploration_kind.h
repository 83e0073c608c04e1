// How a run's actors explore.
#pragma once

#include "common/config/config.h"

namespace shoal {

enum class ExplorationKind { kSquashedGaussian, kGaussian, kOrnsteinUhlenbeck };

// Whether the run's algorithm learns a Gaussian policy; the others' are deterministic.
bool LearnsDeviation(const Config& config);

// What exploration.kind says; `auto` is what the run's algorithm wants: its own Gaussian, or
// Gaussian noise beside a deterministic policy.
ExplorationKind ExplorationKindOf(const Config& config);

}  // namespace shoal
