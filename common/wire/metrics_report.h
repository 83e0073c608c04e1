// SPDX-License-Identifier: Apache-2.0
// Builds the metrics report that a process sends once a second. This class decides when a report is
// due and adds the process's identity. Every metric that a process adds must be in the table of
// metric_names.h.
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

// Only one thread may use an object.
class MetricsReport {
 public:
  explicit MetricsReport(const ProcessName& process);

  // Returns true once a second; the process then calls Begin. A process may also call Begin at
  // other times.
  bool Due(SteadyTime now);

  // Empties the report and ends the interval. Afterwards, add each metric once.
  void Begin(const std::string& state);

  void Add(const std::string& name, double value);
  // Adds NAME_p50, NAME_p90 and NAME_p99, and empties the window. An empty window adds nothing.
  void AddQuantiles(const std::string& name, QuantileWindow* window);
  void AddQuantiles(const std::string& name, const Quantiles& quantiles);
  // Adds the increase of `total` per second over the interval that ended, limited to `most`. Adds
  // nothing if the interval is shorter than kShortest.
  void AddRate(const std::string& name, double total,
               double most = std::numeric_limits<double>::infinity());
  // Adds (increase of `part`) / (increase of `whole`) over the interval that ended. Adds nothing if
  // `whole` did not increase.
  void AddShare(const std::string& name, double part, double whole);
  // Adds two metrics. seconds_STAGE is `total`, the time in a stage since the start. share_STAGE is
  // the stage's share of the interval that ended. The time of a stage is added to the total when
  // the stage ends. The stage may therefore have begun before the interval; the share is limited
  // to 1.
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
  double interval_seconds_ = 0;  // length of the interval that ended at Begin
  // Values of the previous report, by name.
  std::map<std::string, double> totals_;                    // AddRate: total
  std::map<std::string, std::pair<double, double>> parts_;  // AddShare: part and whole
};

// Resident memory of this process.
double ResidentMegabytes();
// Number of open file descriptors of this process. Does not count the descriptor that this function
// itself opens.
int OpenFiles();
// Processor time of this process: user and system time of all threads.
double CpuSeconds();

}  // namespace shoal
