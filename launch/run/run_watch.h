// SPDX-License-Identifier: Apache-2.0
// What the processes of a run say, put together: their newest reports, the figures of late, the
// lines of metrics.jsonl and what is shown to who watches. The coordinator's own report is made
// here: it watches itself as it does the others.
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

// What the coordinator has counted besides.
struct CoordinatorCounts {
  uint64_t messages_dropped = 0, reports_refused = 0;
  uint64_t evaluations_repeated = 0, evaluations_refused = 0;
};

// One thread.
class RunWatch {
 public:
  // Borrows the hub and `faults`. `say` shows a line to who looks at the run.
  RunWatch(const std::filesystem::path& run, const link::Hub& hub,
           std::function<void(const std::string&)> say, WriteFaults* faults);

  // The newest report of each process.
  const MetricsView& view() const { return view_; }

  // Into the view and the file; a file that takes no more is said once.
  void OnReport(const MetricsMessage& report, SteadyTime now);
  // Once a second, at so many seconds and env steps of the run: what the figures of late are made
  // of.
  void LookBack(double seconds, uint64_t env_steps, const RunResources& resources);
  // After a pause, at so many seconds of the run.
  void Forget(double seconds) { recent_.Forget(seconds); }

  // What processes report, with which figures begin.
  ProgressFigures Reported(SteadyTime now) const { return CollectFigures(view_, now); }
  // What was lately, once they have steps and budget.
  void AddLately(ProgressFigures* figures) const { launch::AddLately(recent_, lately_, figures); }
  // Makes the coordinator's own report of `figures`, and returns the reports of all.
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
