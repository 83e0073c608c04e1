// The one table of metrics: what each is called, who reports it, in what unit and what it means.
// docs/monitoring.md and the help texts of the Prometheus endpoint are made from it.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace shoal {

enum class MetricKind {
  kGauge,      // a value now, or over the last interval
  kCounter,    // grows from 0 at the process's start
  kQuantiles,  // NAME_p50, NAME_p90 and NAME_p99 over the last interval
  kStage,      // seconds_NAME, a counter, and share_NAME, the share of the last interval
};

struct Metric {
  std::string_view role;  // "all" = every process
  std::string_view name;
  MetricKind kind;
  std::string_view unit;  // empty: a plain number
  std::string_view meaning;
};

// By role, then as reported.
std::span<const Metric> Metrics();

// The metric that a reported name ("share_physics", "policy_lag_p90") belongs to; nullptr: none of
// this role has the name.
const Metric* FindMetric(std::string_view role, std::string_view reported);

// Markdown table of all.
std::string DescribeMetrics();

}  // namespace shoal
