// SPDX-License-Identifier: Apache-2.0
// The ready dashboard asks for metrics that exist, with the labels that they have.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "common/base/files.h"
#include "launch/watch/prometheus_families.h"
#include "launch/watch/run_metrics.h"
#include "tests/support/paths.h"

namespace shoal::launch {
namespace {

// A view in which every process reports every figure it can.
RunViewMessage FullView() {
  RunViewMessage view;
  view.run = "r";
  for (const char* role : {"coordinator", "actor", "eval", "replay", "learner"}) {
    MetricsMessage process;
    process.role = role;
    process.host = "h";
    for (const Metric& metric : RunMetrics()) {
      if (metric.role != role && metric.role != "all") continue;
      const std::string name(metric.name);
      if (metric.kind == MetricKind::kStage) {
        process.names.insert(process.names.end(), {"seconds_" + name, "share_" + name});
      } else if (metric.kind == MetricKind::kQuantiles) {
        process.names.insert(process.names.end(), {name + "_p50", name + "_p90", name + "_p99"});
      } else {
        process.names.push_back(name);
      }
    }
    process.values.assign(process.names.size(), 1);
    view.processes.push_back(std::move(process));
  }
  return view;
}

// "NAME role" for each role that has the metric, and "NAME ".
std::set<std::string> Served() {
  std::set<std::string> served;
  for (const prometheus::MetricFamily& family : PrometheusFamilies(FullView())) {
    served.insert(family.name + " ");
    for (const prometheus::ClientMetric& metric : family.metric) {
      for (const auto& label : metric.label) {
        if (label.name == "role") served.insert(family.name + " " + label.value);
      }
    }
  }
  return served;
}

TEST(GrafanaDashboard, AsksForMetricsThatExist) {
  const auto dashboard = nlohmann::json::parse(ReadFile(SourcePath("docs/grafana/shoal.json")));
  const std::set<std::string> served = Served();
  const std::regex metric(R"re((shoal_[a-z0-9_]+)\{run="\$run"(?:,role="([a-z]+)")?\})re");
  int asked = 0;
  for (const auto& panel : dashboard.at("panels")) {
    for (const auto& target : panel.at("targets")) {
      const std::string expression = target.at("expr");
      const std::sregex_iterator first(expression.begin(), expression.end(), metric), end;
      EXPECT_NE(first, end) << expression;
      for (auto it = first; it != end; ++it) {
        ++asked;
        EXPECT_TRUE(served.contains((*it)[1].str() + " " + (*it)[2].str())) << expression;
      }
    }
  }
  EXPECT_GT(asked, 30);
}

}  // namespace
}  // namespace shoal::launch
