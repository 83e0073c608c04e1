// SPDX-License-Identifier: Apache-2.0
// The one table of metrics: what each is called, who reports it, in what unit and what it means.
// The figures of updates are their algorithm's to name; launch/watch/run_metrics.h has both.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace shoal {

enum class MetricKind {
  kGauge,      // a value now, or over the last interval
  kCounter,    // grows from 0 at the process's start
  kQuantiles,  // NAME_p50, NAME_p90 and NAME_p99 over the last interval
  kPerTopic,   // NAME_TOPIC for each topic that the process reads, a counter
  kStage,      // seconds_NAME, a counter, and share_NAME, the share of the last interval
  kPerStage,   // NAME_ROLE_STAGE for each stage of each role
};

struct Metric {
  std::string_view role;  // "all" = every process
  std::string_view name;
  MetricKind kind;
  std::string_view unit;  // empty: a plain number
  std::string_view meaning;
};

// All but the figures of updates, by role, then as reported.
std::span<const Metric> ProcessMetrics();

// The one of `metrics` that a reported name ("share_physics", "policy_lag_p90") belongs to;
// nullptr: none of this role has the name.
const Metric* FindMetric(std::span<const Metric> metrics, std::string_view role,
                         std::string_view reported);

// Markdown table of `metrics`.
std::string DescribeMetrics(std::span<const Metric> metrics);

}  // namespace shoal
