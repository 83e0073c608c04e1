// SPDX-License-Identifier: Apache-2.0
// A process's reports, with what its hub counts: malformed_TOPIC, the messages that this process
// could not read.
#pragma once

#include <chrono>

#include "common/link/writer.h"
#include "common/wire/messages.h"

namespace shoal::link {

// Appends malformed_TOPIC for each topic that a reader of the hub reads.
void AddMalformed(const Hub& hub, MetricsMessage* report);

// M: the reports of the process's role (ActorMetrics and others).
template <class M>
class MetricsWriter {
 public:
  // Borrows the hub. Throws Error.
  explicit MetricsWriter(Hub& hub) : hub_(hub), writer_(hub) {}

  // Does what Writer::Write does. A report that is not sent is no loss: the next one holds the same
  // totals.
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
