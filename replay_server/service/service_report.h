// SPDX-License-Identifier: Apache-2.0
// The replay's metrics report, once a second. Counts begin at the start of the process, except
// stored_records and stored_steps, which are totals of the whole run.
#pragma once

#include <algorithm>
#include <string>

#include "common/base/clock.h"
#include "common/wire/metrics_report.h"
#include "common/wire/process_name.h"
#include "replay_server/core/replay_core.h"
#include "replay_server/service/batch_sender.h"
#include "replay_server/service/flow_ages.h"
#include "replay_server/service/gather_threads.h"
#include "replay_server/service/learner_slots.h"
#include "replay_server/service/service_inbox.h"

namespace shoal::replay {

// Use of the service thread's time since its start, in seconds.
struct ServiceSeconds {
  double inserting = 0;  // storing chunks in the ring
  double sampling = 0;   // drawing batches from the ring
  double idle = 0;       // waiting for chunks or requests
  // Time in which credit or batches were withheld. This time overlaps the times above.
  double blocked_insert = 0, blocked_sample = 0;
};

class ServiceReport {
 public:
  // Borrows all arguments except the name.
  ServiceReport(const ProcessName& name, const ReplayCore& core, const ServiceInbox& inbox,
                const BatchSender& sender, const LearnerSlots& slots,
                const GatherThreads& gatherers)
      : core_(core),
        inbox_(inbox),
        sender_(sender),
        slots_(slots),
        gatherers_(gatherers),
        report_(name) {}

  // Records the time that a chunk waited in the inbox.
  void NoteQueueAge(double seconds) { queue_age_seconds_ = std::max(queue_age_seconds_, seconds); }
  // Counts a batch that was drawn into a slot.
  void NoteSlotBatch() { ++slot_batches_; }
  bool Due(SteadyTime now) { return report_.Due(now); }
  // Computes all metrics of the report. Empties the windows of `ages`.
  const MetricsMessage& Make(const std::string& state, const ServiceSeconds& seconds,
                             FlowAges* ages);

 private:
  void Add(const std::string& name, uint64_t value) {
    report_.Add(name, static_cast<double>(value));
  }
  void AddSamples();
  void AddTimes(const ServiceSeconds& seconds);
  void AddTroubles();

  const ReplayCore& core_;
  const ServiceInbox& inbox_;
  const BatchSender& sender_;
  const LearnerSlots& slots_;
  const GatherThreads& gatherers_;
  MetricsReport report_;
  uint64_t slot_batches_ = 0;
  double queue_age_seconds_ = 0;  // largest value in the interval
};

}  // namespace shoal::replay
