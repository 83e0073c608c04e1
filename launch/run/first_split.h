// SPDX-License-Identifier: Apache-2.0
// The division of the cores that a run starts with, expected from what is known before it runs, and
// whether the run may move it afterwards (core_split.h).
#pragma once

#include <optional>

#include "common/config/run_config.h"
#include "launch/watch/best_split.h"

namespace shoal::launch {

// The costs that an env step and an update are going to have on this machine: the one measured
// (`step_microseconds`, pictures included), the other from its arithmetic and what a core of this
// kind computes. Empty without the measurement. Throws Error where the CPU lacks the asked
// precision.
std::optional<CoreCosts> ExpectedCosts(const RunConfig& run, double step_microseconds);

// Within which the run may divide `cores`; empty if it keeps its numbers: both were given
// (`given`: the configuration before 0 was filled in), in lockstep, on policy, without pixels or a
// limiter, with actors on other hosts, and on fewer than kLeastCores, which leave nothing to
// divide.
std::optional<SplitLimits> LimitsOfSplit(const Config& given, bool other_hosts, int cores);

inline constexpr int kLeastCores = 4;

}  // namespace shoal::launch
