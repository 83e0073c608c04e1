// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/run_metrics.h"

#include <vector>

#include "learner/agent/algorithms.h"

namespace shoal::launch {
namespace {

std::vector<Metric> Collect() {
  const auto processes = ProcessMetrics();
  std::vector<Metric> all(processes.begin(), processes.end());
  for (const learner::Figure* figure : learner::AllFigures()) {
    all.push_back({"learner", figure->name, MetricKind::kGauge, figure->unit, figure->meaning});
  }
  return all;
}

}  // namespace

std::span<const Metric> RunMetrics() {
  static const std::vector<Metric> all = Collect();
  return all;
}

}  // namespace shoal::launch
