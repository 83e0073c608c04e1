// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/prometheus_families.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "launch/watch/run_metrics.h"

namespace shoal::launch {
namespace {

using prometheus::ClientMetric;
using prometheus::MetricFamily;
using prometheus::MetricType;

// The seconds and the shares of a stage are two families. Metrics of equal names in several roles
// are one family, with the first help text found.
MetricFamily Describe(const std::string& name, const Metric* metric) {
  MetricFamily family;
  family.name = "shoal_" + name;
  family.type = MetricType::Gauge;
  if (metric == nullptr) return family;
  const bool grows = metric->kind == MetricKind::kCounter ||
                     metric->kind == MetricKind::kPerTopic ||
                     (metric->kind == MetricKind::kStage && name.starts_with("seconds_"));
  if (grows) family.type = MetricType::Counter;
  const bool share = metric->kind == MetricKind::kStage && name.starts_with("share_");
  // The name adds what the meaning leaves out, for example the quantile.
  family.help = name;
  std::ranges::replace(family.help, '_', ' ');
  if (!metric->meaning.empty()) family.help += fmt::format(": {}", metric->meaning);
  if (share) {
    family.help += " (share of the last second)";
  } else if (!metric->unit.empty()) {
    family.help += fmt::format(" ({})", metric->unit);
  }
  return family;
}

class Families {
 public:
  void Add(const std::string& name, const Metric* metric,
           const std::vector<ClientMetric::Label>& labels, double value) {
    if (!std::isfinite(value)) return;
    MetricFamily& family = families_.try_emplace(name, Describe(name, metric)).first->second;
    ClientMetric sample;
    sample.label = labels;
    (family.type == MetricType::Counter ? sample.counter.value : sample.gauge.value) = value;
    family.metric.push_back(std::move(sample));
  }

  std::vector<MetricFamily> Take() {
    std::vector<MetricFamily> list;
    for (auto& [name, family] : families_) list.push_back(std::move(family));
    return list;
  }

 private:
  std::map<std::string, MetricFamily> families_;
};

}  // namespace

std::vector<MetricFamily> PrometheusFamilies(const RunViewMessage& view) {
  static constexpr Metric kSteps{"", "", MetricKind::kGauge, "env steps", "stored in the run"};
  static constexpr Metric kUpdates{"", "", MetricKind::kGauge, "updates", "made in the run"};
  static constexpr Metric kUp{"", "", MetricKind::kGauge, "",
                              "1 if the process reported recently, else 0"};
  Families families;
  families.Add("run_env_steps", &kSteps, {{"run", view.run}}, static_cast<double>(view.env_steps));
  families.Add("run_updates", &kUpdates, {{"run", view.run}}, static_cast<double>(view.updates));
  for (const MetricsMessage& process : view.processes) {
    const std::vector<ClientMetric::Label> labels{{"run", view.run},
                                                  {"role", process.role},
                                                  {"id", std::to_string(process.id)},
                                                  {"host", process.host}};
    families.Add("process_up", &kUp, labels, process.state == "silent" ? 0 : 1);
    for (size_t i = 0; i < process.names.size() && i < process.values.size(); ++i) {
      families.Add(process.names[i], FindMetric(RunMetrics(), process.role, process.names[i]),
                   labels, process.values[i]);
    }
  }
  return families.Take();
}

}  // namespace shoal::launch
