// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/run_metrics.h"

#include <gtest/gtest.h>

#include <set>
#include <utility>

#include "common/base/files.h"
#include "tests/support/paths.h"

namespace shoal::launch {
namespace {

TEST(RunMetrics, AreUniqueWithinARole) {
  std::set<std::pair<std::string_view, std::string_view>> seen;
  for (const Metric& metric : RunMetrics()) {
    EXPECT_TRUE(seen.emplace(metric.role, metric.name).second) << metric.role << ' ' << metric.name;
  }
}

TEST(RunMetrics, HoldWhatProcessesAndUpdatesReport) {
  ASSERT_NE(FindMetric(RunMetrics(), "learner", "share_forward"), nullptr);
  ASSERT_NE(FindMetric(RunMetrics(), "learner", "critic_loss"), nullptr);
  EXPECT_EQ(FindMetric(RunMetrics(), "learner", "entropy")->unit, "nats");
  EXPECT_EQ(FindMetric(ProcessMetrics(), "learner", "critic_loss"), nullptr);
}

TEST(RunMetrics, TheDocumentationIsThisTable) {
  const std::string page = ReadFile(SourcePath("docs/monitoring.md"));
  EXPECT_NE(page.find(DescribeMetrics(RunMetrics())), std::string::npos)
      << "docs/monitoring.md must hold what `shoal top --describe` prints:\n"
      << DescribeMetrics(RunMetrics());
}

}  // namespace
}  // namespace shoal::launch
