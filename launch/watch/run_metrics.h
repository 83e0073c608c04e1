// SPDX-License-Identifier: Apache-2.0
// Every metric that a run can report: the metrics of its processes (common/wire/metric_names.h) and
// the figures of the updates, under the names that the algorithms give them
// (learner/agent/algorithms.h). docs/monitoring.md and the help texts of the Prometheus endpoint
// are made from this list.
#pragma once

#include <span>

#include "common/wire/metric_names.h"

namespace shoal::launch {

// Sorted by role, then in the order of the report; the figures of the updates are last.
std::span<const Metric> RunMetrics();

}  // namespace shoal::launch
