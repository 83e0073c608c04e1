// The replay's 1 Hz report. Counts are since the process started; stored_records and stored_steps
// are of the whole run.
#pragma once

#include <string>

#include "common/base/clock.h"
#include "common/wire/metrics_report.h"
#include "replay_server/core/replay_core.h"
#include "replay_server/service/batch_sender.h"
#include "replay_server/service/service_inbox.h"

namespace shoal::replay {

class ServiceReport {
 public:
  // Borrows all three.
  ServiceReport(const ReplayCore& core, const ServiceInbox& inbox, const BatchSender& sender)
      : core_(core), inbox_(inbox), sender_(sender), report_("replay", 0) {}

  // `seconds` went by in which inserts, samples or neither were blocked.
  void AddTime(double seconds, bool inserts_blocked, bool samples_blocked);
  bool Due(SteadyTime now) { return report_.Due(now); }
  // Fills in every figure.
  const MetricsMessage& Make(const std::string& state);

 private:
  void Add(const std::string& name, uint64_t value) {
    report_.Add(name, static_cast<double>(value));
  }
  // A count and its rate over the last interval.
  void AddRate(const std::string& name, uint64_t value, uint64_t* before);

  const ReplayCore& core_;
  const ServiceInbox& inbox_;
  const BatchSender& sender_;
  MetricsReport report_;
  double blocked_insert_seconds_ = 0, blocked_sample_seconds_ = 0;
  uint64_t records_before_ = 0, sampled_before_ = 0;
};

}  // namespace shoal::replay
