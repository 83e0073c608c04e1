// SPDX-License-Identifier: Apache-2.0
#include "common/wire/metric_names.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>

namespace shoal {
namespace {

TEST(MetricNames, AreUniqueWithinARole) {
  std::set<std::pair<std::string_view, std::string_view>> seen;
  for (const Metric& metric : ProcessMetrics()) {
    EXPECT_TRUE(seen.emplace(metric.role, metric.name).second) << metric.role << ' ' << metric.name;
  }
}

TEST(MetricNames, ReportedNamesAreFoundWithTheirRole) {
  ASSERT_NE(FindMetric(ProcessMetrics(), "actor", "share_physics"), nullptr);
  EXPECT_EQ(FindMetric(ProcessMetrics(), "actor", "seconds_physics")->name, "physics");
  EXPECT_EQ(FindMetric(ProcessMetrics(), "replay", "policy_lag_p90")->unit, "updates");
  EXPECT_EQ(FindMetric(ProcessMetrics(), "learner", "rss_mb")->unit, "MB");
  EXPECT_EQ(FindMetric(ProcessMetrics(), "learner", "share_physics"), nullptr);
  EXPECT_EQ(FindMetric(ProcessMetrics(), "actor", "physics"), nullptr);
  EXPECT_EQ(FindMetric(ProcessMetrics(), "replay", "policy_lag"), nullptr);
  EXPECT_EQ(FindMetric(ProcessMetrics(), "replay", "policy_lag_p95"), nullptr);
  EXPECT_EQ(FindMetric(ProcessMetrics(), "coordinator", "recent_learner_backward")->name, "recent");
  EXPECT_EQ(FindMetric(ProcessMetrics(), "coordinator", "recent_learner_physics"), nullptr);
  EXPECT_EQ(FindMetric(ProcessMetrics(), "coordinator", "recent_cores")->unit, "cores");
}

}  // namespace
}  // namespace shoal
