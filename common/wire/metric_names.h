// SPDX-License-Identifier: Apache-2.0
// Table of the metrics that processes report: name, role, unit and meaning of each metric. Metrics
// of updates are not in this table: each algorithm has its own list of them.
// launch/watch/run_metrics.h combines the table with these lists.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace shoal {

enum class MetricKind {
  kGauge,      // present value, or value over the last interval
  kCounter,    // total since the process's start
  kQuantiles,  // NAME_p50, NAME_p90 and NAME_p99 over the last interval
  kPerTopic,   // NAME_TOPIC for each topic that the process reads; a counter
  kStage,      // seconds_NAME (a counter) and share_NAME (share of the last interval)
  kPerStage,   // NAME_ROLE_STAGE for each stage of each role
};

struct Metric {
  std::string_view role;  // "all" = every process
  std::string_view name;
  MetricKind kind;
  std::string_view unit;  // empty: a plain number
  std::string_view meaning;
};

// All metrics except those of updates, ordered by role, and within a role in the order of the
// reports.
std::span<const Metric> ProcessMetrics();

// The metric of `role` among `metrics` to which a reported name ("share_physics",
// "policy_lag_p90") belongs; nullptr if there is no such metric.
const Metric* FindMetric(std::span<const Metric> metrics, std::string_view role,
                         std::string_view reported);

// Markdown table of `metrics`.
std::string DescribeMetrics(std::span<const Metric> metrics);

}  // namespace shoal
