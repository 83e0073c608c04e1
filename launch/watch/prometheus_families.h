// SPDX-License-Identifier: Apache-2.0
// From a run's view to what Prometheus's client library serialises. Pure.
#pragma once

#include <prometheus/metric_family.h>

#include <vector>

#include "common/wire/messages.h"

namespace shoal::launch {

// One family per metric name, sorted by name; figures that are not finite are left out.
std::vector<prometheus::MetricFamily> PrometheusFamilies(const RunViewMessage& view);

}  // namespace shoal::launch
