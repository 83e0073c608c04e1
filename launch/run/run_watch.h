// SPDX-License-Identifier: Apache-2.0
// Collects the reports of a run's processes: the newest report of each process, recent rates, the
// lines of metrics.jsonl and the metrics of the display. Also makes the coordinator's own report
// and treats it like the other reports.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/base/write_faults.h"
#include "common/link/hub.h"
#include "launch/record/metrics_log.h"
#include "launch/watch/metrics_view.h"
#include "launch/watch/recent_run.h"
#include "launch/watch/run_figures.h"

namespace shoal::launch {

// Counts of the coordinator itself.
struct CoordinatorCounts {
  uint64_t messages_dropped = 0, reports_refused = 0;
  uint64_t evaluations_repeated = 0, evaluations_refused = 0;
};

// One thread.
class RunWatch {
 public:
  // Borrows the hub and `faults`. `say` shows a line to the user.
  RunWatch(const std::filesystem::path& run, const link::Hub& hub,
           std::function<void(const std::string&)> say, WriteFaults* faults);

  // The newest report of each process.
  const MetricsView& view() const { return view_; }

  // Adds a report to the view and the file. If the file cannot be written, reports this once.
  void OnReport(const MetricsMessage& report, SteadyTime now);
  // Samples the run for the recent rates. Call it once a second; `seconds` and `env_steps` count
  // from the run's start.
  void LookBack(double seconds, uint64_t env_steps, const RunResources& resources);
  // Drops the recent rates after a pause. `seconds`: time since the run's start.
  void Forget(double seconds) { recent_.Forget(seconds); }

  // Metrics from the processes' reports, for the display.
  ProgressFigures Reported(SteadyTime now) const { return CollectFigures(view_, now); }
  // Adds the recent rates. `figures` must have steps and budget already.
  void AddLately(ProgressFigures* figures) const { launch::AddLately(recent_, lately_, figures); }
  // Makes the coordinator's own report from `figures`, and returns the reports of all processes.
  std::vector<MetricsMessage> Reports(const ProgressFigures& figures, const Config& config,
                                      const RunResources& resources,
                                      const CoordinatorCounts& counts, SteadyTime now);

 private:
  void WriteLine(const MetricsMessage& report);

  const link::Hub& hub_;
  const std::function<void(const std::string&)> say_;
  WriteFaults& faults_;
  MetricsView view_;
  RecentRun recent_;
  Bottleneck lately_;
  MetricsLog log_;
  MetricsReport own_report_;
  uint64_t dropped_said_ = 0;
  bool full_said_ = false;
};

}  // namespace shoal::launch
