// SPDX-License-Identifier: Apache-2.0
// Converts a run's view to the metric families that Prometheus's client library serialises. Pure.
#pragma once

#include <prometheus/metric_family.h>

#include <vector>

#include "common/wire/messages.h"

namespace shoal::launch {

// One family per metric name, sorted by name; values that are not finite are left out.
std::vector<prometheus::MetricFamily> PrometheusFamilies(const RunViewMessage& view);

}  // namespace shoal::launch
