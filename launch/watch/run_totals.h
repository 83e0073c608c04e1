// SPDX-License-Identifier: Apache-2.0
// Counters of a run's processes, summed by role. The difference between two moments shows how the
// time between the moments was used. Pure.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "launch/watch/metrics_view.h"

namespace shoal::launch {

inline constexpr std::string_view kCountedRoles[] = {"actor", "replay", "learner", "eval"};

// Sums over all processes of a role, including processes that have ended.
struct RoleTotals {
  int processes = 0;                                    // number that have reported so far
  double seconds = 0;                                   // run time
  double cpu_seconds = 0;                               // processor time
  std::map<std::string, double, std::less<>> stages{};  // seconds spent in each stage
  // Seconds in which the limiter held back the actors, and the learner; only for the replay.
  double inserts_blocked = 0, samples_blocked = 0;
};

using RunTotals = std::map<std::string, RoleTotals, std::less<>>;

// Totals since the processes' starts. Roles that have not reported are absent.
RunTotals TotalsOf(const MetricsView& view);

// Difference of `now` and `before`. Roles that have not run in this time are absent.
RunTotals Since(const RunTotals& before, const RunTotals& now);

}  // namespace shoal::launch
