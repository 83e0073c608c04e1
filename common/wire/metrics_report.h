// A process's 1 Hz report: says when it is due and fills in who reports.
#pragma once

#include <string>

#include "common/base/clock.h"
#include "common/wire/messages.h"

namespace shoal {

// One thread.
class MetricsReport {
 public:
  MetricsReport(const std::string& role, uint32_t id);

  // True once a second; the interval then ends here.
  bool Due(SteadyTime now);
  // Seconds of the interval that ended last.
  double interval_seconds() const { return interval_seconds_; }

  // Empties the report; then Add each figure once.
  void Begin(const std::string& state);
  void Add(const std::string& name, double value);
  const MetricsMessage& message() const { return message_; }

 private:
  MetricsMessage message_;
  SteadyTime last_;
  double interval_seconds_ = 0;
};

// Resident memory of this process.
double ResidentMegabytes();

}  // namespace shoal
