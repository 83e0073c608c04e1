// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/run_totals.h"

#include "common/wire/metric_names.h"

namespace shoal::launch {
RunTotals TotalsOf(const MetricsView& view) {
  RunTotals totals;
  for (const std::string_view role : kCountedRoles) {
    RoleTotals all{.processes = view.Processes(role), .seconds = view.Seconds(role)};
    if (all.seconds <= 0) continue;
    all.cpu_seconds = view.Total(role, "cpu_seconds");
    for (const Metric& metric : ProcessMetrics()) {
      if (metric.role != role || metric.kind != MetricKind::kStage) continue;
      const std::string stage(metric.name);
      all.stages[stage] = view.Total(role, "seconds_" + stage);
    }
    all.inserts_blocked = view.Total(role, "limiter_blocked_insert_seconds");
    all.samples_blocked = view.Total(role, "limiter_blocked_sample_seconds");
    totals.emplace(role, std::move(all));
  }
  return totals;
}

RunTotals Since(const RunTotals& before, const RunTotals& now) {
  RunTotals grown;
  for (const auto& [role, totals] : now) {
    const auto former = before.find(role);
    RoleTotals growth = totals;
    if (former != before.end()) {
      growth.seconds -= former->second.seconds;
      growth.cpu_seconds -= former->second.cpu_seconds;
      growth.inserts_blocked -= former->second.inserts_blocked;
      growth.samples_blocked -= former->second.samples_blocked;
      for (const auto& [stage, seconds] : former->second.stages) growth.stages[stage] -= seconds;
    }
    if (growth.seconds > 0) grown.emplace(role, std::move(growth));
  }
  return grown;
}

}  // namespace shoal::launch
