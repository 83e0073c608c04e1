// SPDX-License-Identifier: Apache-2.0
// Sends the reports of a process. Adds the hub's counters to each report: malformed_TOPIC, the
// number of messages of a topic that this process could not read.
#pragma once

#include <chrono>

#include "common/link/writer.h"
#include "common/wire/messages.h"

namespace shoal::link {

// Appends malformed_TOPIC for each topic that a reader of the hub reads.
void AddMalformed(const Hub& hub, MetricsMessage* report);

// M: the report message of the process's role (ActorMetrics and others).
template <class M>
class MetricsWriter {
 public:
  // Borrows the hub. Throws Error.
  explicit MetricsWriter(Hub& hub) : hub_(hub), writer_(hub) {}

  // Sends the report as Writer::Write does. If a report is not sent, no count is lost, because the
  // next report contains the totals.
  bool Write(const MetricsMessage& report) {
    M message;
    static_cast<MetricsMessage&>(message) = report;
    AddMalformed(hub_, &message);
    return writer_.Write(message);
  }
  bool WaitForAcks(std::chrono::milliseconds deadline) { return writer_.WaitForAcks(deadline); }

 private:
  const Hub& hub_;
  Writer<M> writer_;
};

}  // namespace shoal::link
