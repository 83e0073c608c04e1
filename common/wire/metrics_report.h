// SPDX-License-Identifier: Apache-2.0
// Builds a process's 1 Hz report: decides when the report is due and fills in the process's
// identity. Every name that a process adds is in the table of metric_names.h.
#pragma once

#include <limits>
#include <map>
#include <string>
#include <utility>

#include "common/base/clock.h"
#include "common/wire/messages.h"
#include "common/wire/process_name.h"
#include "common/wire/quantile_window.h"

namespace shoal {

// One thread.
class MetricsReport {
 public:
  explicit MetricsReport(const ProcessName& process);

  // Returns true once a second. The process then calls Begin; Begin may be called at other times
  // too.
  bool Due(SteadyTime now);

  // Empties the report and ends the interval. Add each figure once afterwards.
  void Begin(const std::string& state);

  void Add(const std::string& name, double value);
  // Adds NAME_p50, NAME_p90 and NAME_p99, and empties the window. An empty window adds nothing.
  void AddQuantiles(const std::string& name, QuantileWindow* window);
  void AddQuantiles(const std::string& name, const Quantiles& quantiles);
  // Adds the growth of `total` per second, over the interval that ended; at most `most`. Adds
  // nothing if the interval is shorter than kShortest.
  void AddRate(const std::string& name, double total,
               double most = std::numeric_limits<double>::infinity());
  // Adds (growth of `part`) / (growth of `whole`) over the interval that ended. Adds nothing if
  // `whole` did not grow.
  void AddShare(const std::string& name, double part, double whole);
  // Adds seconds_STAGE, the `total` of seconds in a stage since the start, and share_STAGE, the
  // stage's share of the interval that ended. Seconds are counted when a stage ends. If a stage
  // began before the interval (for example, a send without a receiver), its share is at most 1.
  void AddSeconds(const std::string& stage, double total);
  // Adds the process's uptime and its use of the host: uptime_seconds, rss_mb, open_files,
  // cpu_seconds, cpu_share.
  void AddResources();

  const MetricsMessage& message() const { return message_; }

 private:
  static constexpr double kShortest = 0.1;  // s; shorter intervals give no meaningful rates

  MetricsMessage message_;
  const SteadyTime start_;
  SteadyTime last_due_, last_begin_;
  double interval_seconds_ = 0;  // of the interval that ended at Begin
  // Last values by name.
  std::map<std::string, double> totals_;                    // of AddRate
  std::map<std::string, std::pair<double, double>> parts_;  // of AddShare: part and whole
};

// Resident memory of this process.
double ResidentMegabytes();
// Number of open file descriptors of this process, without the one that is used to count them.
int OpenFiles();
// Processor time of this process, all threads, user and system.
double CpuSeconds();

}  // namespace shoal
