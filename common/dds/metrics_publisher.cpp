// SPDX-License-Identifier: Apache-2.0
#include "common/dds/metrics_publisher.h"

namespace shoal::dds {

void AddMalformed(const Bus& bus, MetricsMessage* report) {
  for (const auto& [topic, count] : bus.Malformed()) {
    report->names.push_back("malformed_" + topic);
    report->values.push_back(static_cast<double>(count));
  }
}

}  // namespace shoal::dds
