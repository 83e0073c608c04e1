// SPDX-License-Identifier: Apache-2.0
// Executes the runs of an experiment: for each run the processes of `shoal train`, then the
// evaluations on further tasks.
#pragma once

#include <optional>
#include <vector>

#include "launch/processes/child_process.h"
#include "launch/tools/experiment/run_queue.h"

namespace shoal::launch {

// Divides `cores` into `jobs` parts of neighbouring CPUs. If there is a remainder, the first parts
// get one more CPU each. Throws Error (usage) if there are fewer CPUs than jobs.
std::vector<std::vector<int>> SplitCores(const std::vector<int>& cores, int jobs);
// The CPUs on which this process may run. If the cgroups grant less CPU time, correspondingly
// fewer.
std::vector<int> OwnCores();

// One thread, which must live as long as the children (child_process.h).
class ProcessRunner : public RunKeeper {
 public:
  // Borrows the experiment. If there are several jobs, the runs of a slot use only the cores of one
  // part (SplitCores). `side_by_side`: number of runs that may execute at the same time, including
  // the runs of other processes.
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

  // Describes the process of the training, without the cores.
  ProcessSpec Training(const ExperimentRun& run) const;
  // Describes the process of the evaluation on a further task, without the cores.
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
