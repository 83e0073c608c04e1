// SPDX-License-Identifier: Apache-2.0
// The commands `shoal experiment run` and `shoal experiment task`.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace shoal::launch {

struct ExperimentOptions {
  std::string definition;         // file, or name of a definition in launch/data/experiments
  std::vector<int64_t> seeds;     // empty = the definition's seeds
  std::vector<std::string> arms;  // by name; empty = all
  // Number of runs at the same time, each with its own cores (1 if empty); for a job array, number
  // of tasks at a time (all if empty).
  std::optional<int> jobs;
  std::string out;  // folder; empty = experiments/NAME
  bool retry_failed = false;
  bool dry_run = false;  // checks everything, including the folder; starts and writes nothing
  bool slurm = false;    // submits the unfinished runs as a job array
  std::vector<std::string> sbatch_options;
};

// One run of an experiment, executed by one task of a job array.
struct ExperimentTask {
  std::string folder;
  std::string run;       // ARM-sSEED
  int side_by_side = 1;  // tasks that may execute at the same time, including this one
  bool retry_failed = false;
};

// Executes the unfinished runs of the experiment. Progress is written to stderr; stdout gets one
// line of JSON for each processed run: {run, arm, seed, status, objective, path}. Returns 0 if
// every run is finished, 1 if not, kInterruptedExit (stop.h) after Ctrl-C. Throws Error, before
// anything is written, if the definition, the folder or an arm is refused.
//
// If `slurm` is true, submits a job array instead and writes one line of JSON, {job, script, runs},
// to stdout. Returns 0 unless Slurm refuses.
int RunExperiment(const ExperimentOptions& options);

// Executes one run; output and exit code are those of RunExperiment. Any number of processes may
// call RunExperimentTask for one experiment, on any hosts that share its folder. Throws Error if
// there is no experiment in the folder or no such run, or if a command executes the whole
// experiment.
int RunExperimentTask(const ExperimentTask& task);

}  // namespace shoal::launch
