// SPDX-License-Identifier: Apache-2.0
// A process's reports, with what the transport itself counts: malformed_TOPIC, the messages that
// this process could not read.
#pragma once

#include <chrono>

#include "common/dds/bus.h"
#include "common/dds/publisher.h"
#include "common/wire/messages.h"

namespace shoal::dds {

// Appends malformed_TOPIC for each topic that a subscriber of the bus reads.
void AddMalformed(const Bus& bus, MetricsMessage* report);

// M: the reports of the process's role (ActorMetrics and others).
template <class M>
class MetricsPublisher {
 public:
  // Borrows the bus. Throws Error when DDS refuses.
  explicit MetricsPublisher(Bus& bus) : bus_(bus), publisher_(bus) {}

  // As Publisher::Write. A report that is not sent is no loss: the next one holds the same totals.
  bool Write(const MetricsMessage& report) {
    M message;
    static_cast<MetricsMessage&>(message) = report;
    AddMalformed(bus_, &message);
    return publisher_.Write(message);
  }
  bool WaitForAcks(std::chrono::milliseconds deadline) { return publisher_.WaitForAcks(deadline); }

 private:
  const Bus& bus_;
  Publisher<M> publisher_;
};

}  // namespace shoal::dds
