// SPDX-License-Identifier: Apache-2.0
// Every metric that a run can report: the metrics of its processes (common/wire/metric_names.h) and
// the metrics of the updates, with the names that the algorithms define
// (learner/agent/algorithms.h). docs/monitoring.md and the help texts of the Prometheus endpoint
// are made from this list.
#pragma once

#include <span>

#include "common/wire/metric_names.h"

namespace shoal::launch {

// The metrics sorted by role, then in the order of the report. The metrics of the updates are last.
std::span<const Metric> RunMetrics();

}  // namespace shoal::launch
