#include "common/wire/metric_names.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "common/base/files.h"

namespace shoal {
namespace {

TEST(MetricNames, AreUniqueWithinARole) {
  std::set<std::pair<std::string_view, std::string_view>> seen;
  for (const Metric& metric : Metrics()) {
    EXPECT_TRUE(seen.emplace(metric.role, metric.name).second) << metric.role << ' ' << metric.name;
  }
}

TEST(MetricNames, ReportedNamesAreFoundWithTheirRole) {
  ASSERT_NE(FindMetric("actor", "share_physics"), nullptr);
  EXPECT_EQ(FindMetric("actor", "seconds_physics")->name, "physics");
  EXPECT_EQ(FindMetric("replay", "policy_lag_p90")->unit, "updates");
  EXPECT_EQ(FindMetric("learner", "rss_mb")->unit, "MB");
  EXPECT_EQ(FindMetric("learner", "share_physics"), nullptr);
  EXPECT_EQ(FindMetric("actor", "physics"), nullptr);
  EXPECT_EQ(FindMetric("replay", "policy_lag"), nullptr);
  EXPECT_EQ(FindMetric("replay", "policy_lag_p95"), nullptr);
}

TEST(MetricNames, TheDocumentationIsThisTable) {
  const std::string page = ReadFile(SHOAL_SOURCE_DIR "/docs/monitoring.md");
  EXPECT_NE(page.find(DescribeMetrics()), std::string::npos)
      << "docs/monitoring.md must hold what `shoal top --describe` prints:\n"
      << DescribeMetrics();
}

}  // namespace
}  // namespace shoal
