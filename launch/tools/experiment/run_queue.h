// SPDX-License-Identifier: Apache-2.0
// Queue that executes the runs of an experiment. Finished runs are skipped, interrupted runs are
// continued, and a failed run does not stop the following runs. RunKeeper hides processes and files
// from the queue.
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
  // Starts or continues the run on the cores of a free slot (0 <= slot < jobs).
  virtual void Start(const ExperimentRun& run, int slot) = 0;
  // Whether the run of this slot has ended, so that the slot is free; does not wait.
  virtual bool Ended(int slot) = 0;
  // First call: asks every active run to stop in order. Second call: stops the runs at once.
  virtual void Stop() = 0;
};

struct QueueTerms {
  int jobs = 1;
  bool retry_failed = false;
};

struct QueueHooks {
  std::function<int()> stops;  // number of stop requests so far
  std::function<void()> wait;  // waits between two polls of the runs
  std::function<void(const std::string&)> say;
  // Called for each run that is skipped or has ended.
  std::function<void(const ExperimentRun&, const StandingReport&)> done;
};

// Executes every run once, in order, until all are processed, or until a stop was requested and the
// active runs have ended. A run that another process still holds is postponed, because the
// processes of a killed command need some time to exit.
void DoRuns(const std::vector<ExperimentRun>& runs, const QueueTerms& terms, RunKeeper& keeper,
            const QueueHooks& hooks);

}  // namespace shoal::launch
