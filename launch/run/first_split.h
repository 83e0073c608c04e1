// SPDX-License-Identifier: Apache-2.0
// The first division of the cores, computed from costs that are expected before the run. Also
// decides whether the run may change the division later (core_split.h).
#pragma once

#include <optional>

#include "common/config/run_config.h"
#include "launch/watch/best_split.h"

namespace shoal::launch {

// Expected costs of an env step and an update on this machine. The cost of an env step is measured
// (`step_microseconds`, pictures included). The cost of an update is computed from its arithmetic
// and the speed of a core of this kind. Empty if there is no measurement (0). Throws Error if the
// CPU lacks the requested precision.
std::optional<CoreCosts> ExpectedCosts(const RunConfig& run, double step_microseconds);

// Limits within which the run may divide `cores`. Empty if the numbers of actors and learner
// threads stay: if both are given (`given`: the configuration with 0 for unset numbers), in
// lockstep, on policy, without pixels, without a limiter, with actors on other hosts, or with fewer
// than kLeastCores cores.
std::optional<SplitLimits> LimitsOfSplit(const Config& given, bool other_hosts, int cores);

inline constexpr int kLeastCores = 4;

}  // namespace shoal::launch
