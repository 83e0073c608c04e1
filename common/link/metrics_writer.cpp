// SPDX-License-Identifier: Apache-2.0
#include "common/link/metrics_writer.h"

namespace shoal::link {

void AddMalformed(const Hub& hub, MetricsMessage* report) {
  for (const auto& [topic, count] : hub.Malformed()) {
    report->names.push_back("malformed_" + topic);
    report->values.push_back(static_cast<double>(count));
  }
}

}  // namespace shoal::link
