// SPDX-License-Identifier: Apache-2.0
// A process's 1 Hz report: says when it is due and fills in who reports. Every name that a process
// adds is in the table of metric_names.h.
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

  // True once a second; then, or at any other time, Begin.
  bool Due(SteadyTime now);

  // Empties the report, ends the interval; then Add each figure once.
  void Begin(const std::string& state);

  void Add(const std::string& name, double value);
  // NAME_p50, NAME_p90 and NAME_p99; nothing where the window is empty. Empties it.
  void AddQuantiles(const std::string& name, QuantileWindow* window);
  void AddQuantiles(const std::string& name, const Quantiles& quantiles);
  // `total` grows: its growth per second of the interval that ended, nothing where that is too
  // short to tell; at most `most`.
  void AddRate(const std::string& name, double total,
               double most = std::numeric_limits<double>::infinity());
  // `part` and `whole` grow: the share that the one has of the other in what they grew by in the
  // interval that ended, nothing where `whole` did not grow.
  void AddShare(const std::string& name, double part, double whole);
  // Time spent in a stage, of seconds since the start: seconds_STAGE and share_STAGE, the share of
  // the interval that ended. Seconds are counted when a stage ends: one that began before the
  // interval, as a send without a receiver, has all of it, and not more.
  void AddSeconds(const std::string& stage, double total);
  // How long the process reports and what it takes of its host: uptime_seconds, rss_mb, open_files,
  // cpu_seconds, cpu_share.
  void AddResources();

  const MetricsMessage& message() const { return message_; }

 private:
  static constexpr double kShortest = 0.1;  // seconds; shares of less say nothing

  MetricsMessage message_;
  const SteadyTime start_;
  SteadyTime last_due_, last_begin_;
  double interval_seconds_ = 0;  // of the interval that ended at Begin
  // At the last Begin, by name.
  std::map<std::string, double> totals_;                    // of AddRate
  std::map<std::string, std::pair<double, double>> parts_;  // of AddShare: part and whole
};

// Resident memory of this process.
double ResidentMegabytes();
// Open file descriptors of this process, without the one it takes to count them.
int OpenFiles();
// Processor time of this process, all threads, user and system.
double CpuSeconds();

}  // namespace shoal
