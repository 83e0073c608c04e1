// SPDX-License-Identifier: Apache-2.0
// `shoal experiment run`, status and summary.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace shoal::launch {

struct ExperimentOptions {
  std::string definition;         // file, or name of one in launch/data/experiments
  std::vector<int64_t> seeds;     // empty = the definition's
  std::vector<std::string> arms;  // by name; empty = all
  // Runs side by side, each with cores of its own (default 1); of an array, tasks at a time
  // (default: all).
  std::optional<int> jobs;
  std::string out;  // folder; empty = experiments/NAME
  bool retry_failed = false;
  bool dry_run = false;  // check everything, the folder included; start and make nothing
  bool slurm = false;    // submit what is to be done as a job array
  std::vector<std::string> sbatch_options;
};

// One run of an experiment, as a task of an array does it.
struct ExperimentTask {
  std::string folder;
  std::string run;       // ARM-sSEED
  int side_by_side = 1;  // tasks that may be under way at the same time, this one included
  bool retry_failed = false;
};

// Does what is still to be done of the experiment. Progress goes to stderr; stdout gets one line of
// JSON for each run that is done with: {run, arm, seed, status, objective, path}. 0 once every run
// is finished, 1 when one is not, kInterruptedExit (stop.h) after Ctrl-C. Throws Error before
// anything is written where the definition, the folder or an arm is refused.
//
// A job array (--slurm) is submitted instead, and stdout gets one line of JSON, {job, script,
// runs}; 0 unless Slurm refuses.
int RunExperiment(const ExperimentOptions& options);

// Does one run; output and exit code as RunExperiment's. Any number of these may run of an
// experiment, on any hosts that share its folder. Throws Error: no experiment there, no such run,
// or a command runs the experiment whole.
int RunExperimentTask(const ExperimentTask& task);

}  // namespace shoal::launch
