// SPDX-License-Identifier: Apache-2.0
// Counters of a run's processes, summed by role. The difference of two moments gives the use of the
// time between them. Pure.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "launch/watch/metrics_view.h"

namespace shoal::launch {

inline constexpr std::string_view kCountedRoles[] = {"actor", "replay", "learner", "eval"};

// All processes of a role together, ended ones included.
struct RoleTotals {
  int processes = 0;                                    // that have reported so far
  double seconds = 0;                                   // they ran
  double cpu_seconds = 0;                               // processor time they took
  std::map<std::string, double, std::less<>> stages{};  // seconds spent in each
  // Seconds in which the limiter held actors back and the learner; of the replay.
  double inserts_blocked = 0, samples_blocked = 0;
};

using RunTotals = std::map<std::string, RoleTotals, std::less<>>;

// Since the processes' starts. Roles that have not reported are absent.
RunTotals TotalsOf(const MetricsView& view);

// From `before` to `now`. Roles that have not run meanwhile are absent.
RunTotals Since(const RunTotals& before, const RunTotals& now);

}  // namespace shoal::launch
