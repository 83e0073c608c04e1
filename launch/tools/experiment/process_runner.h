// SPDX-License-Identifier: Apache-2.0
// Does the runs of an experiment: a process tree of `shoal train` for each, and the evaluations on
// further tasks after it.
#pragma once

#include <optional>
#include <vector>

#include "launch/processes/child_process.h"
#include "launch/tools/experiment/run_queue.h"

namespace shoal::launch {

// The CPUs this process may run on, as many as the cgroups grant time for, in `jobs` parts of
// neighbours; the first ones get one more where it does not divide. Throws Error (usage) where
// there are fewer CPUs than jobs.
std::vector<std::vector<int>> SplitCores(const std::vector<int>& cores, int jobs);
std::vector<int> OwnCores();

// One thread, which must live as long as the children (child_process.h).
class ProcessRunner : public RunKeeper {
 public:
  // Borrows the experiment. More than one job: each slot's runs get the cores of their part alone.
  // `side_by_side`: runs that may be under way at the same time, those of other keepers included.
  ProcessRunner(const StoredExperiment& experiment, int jobs, int side_by_side);

  StandingReport Standing(const ExperimentRun& run) override;
  void Start(const ExperimentRun& run, int slot) override;
  bool Ended(int slot) override;
  void Stop() override;

 private:
  struct Slot {
    std::vector<int> cores;  // empty = all
    std::optional<ExperimentRun> run;
    std::optional<ChildProcess> process;
  };

  // Ready but for the cores.
  ProcessSpec Training(const ExperimentRun& run) const;
  // Evaluation on a further task.
  ProcessSpec Transfer(const ExperimentRun& run, const std::string& task) const;
  void Launch(ProcessSpec spec, Slot& slot);
  void LogEnding(const ExperimentRun& run, const ExitStatus& status) const;

  const StoredExperiment& experiment_;
  const RunLog log_;
  const int side_by_side_;
  std::vector<Slot> slots_;
  bool stopping_ = false;
};

}  // namespace shoal::launch
