// SPDX-License-Identifier: Apache-2.0
// The order in which the runs of an experiment are done: what is finished is skipped, what was
// interrupted goes on, past what failed the next one begins. Knows no processes and no files: they
// are behind RunKeeper.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "launch/tools/experiment/experiment_folder.h"
#include "launch/tools/experiment/experiment_run_status.h"

namespace shoal::launch {

class RunKeeper {
 public:
  virtual ~RunKeeper() = default;

  virtual StandingReport Standing(const ExperimentRun& run) = 0;
  // Begins the run, or goes on with it, on the cores of a free slot (0 <= slot < jobs).
  virtual void Start(const ExperimentRun& run, int slot) = 0;
  // Whether the run of this slot has ended; does not wait. Once true, the slot is free.
  virtual bool Ended(int slot) = 0;
  // Asks every run under way to stop in order; asked again, at once.
  virtual void Stop() = 0;
};

struct QueueTerms {
  int jobs = 1;
  bool retry_failed = false;
};

struct QueueHooks {
  std::function<int()> stops;  // how many times a stop was asked for
  std::function<void()> wait;  // between two looks at the runs
  std::function<void(const std::string&)> say;
  // The run is done with for now: skipped, or ended.
  std::function<void(const ExperimentRun&, const StandingReport&)> done;
};

// Does every run once, in order, until all are done with or a stop was asked for and what was under
// way has ended. A run that another process still holds is put off: processes of a killed command
// need a while to end.
void DoRuns(const std::vector<ExperimentRun>& runs, const QueueTerms& terms, RunKeeper& keeper,
            const QueueHooks& hooks);

}  // namespace shoal::launch
