// SPDX-License-Identifier: Apache-2.0
// Every metric that a run can report: what its processes report of themselves
// (common/wire/metric_names.h) and the figures of the updates, as the algorithms name them
// (learner/agent/algorithms.h). docs/monitoring.md and the help texts of the Prometheus endpoint
// are made from it.
#pragma once

#include <span>

#include "common/wire/metric_names.h"

namespace shoal::launch {

// By role, then as reported; the updates' figures last.
std::span<const Metric> RunMetrics();

}  // namespace shoal::launch
