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
  // Runs at the same time, each with cores of its own (default 1); for a job array, tasks at a time
  // (default: all).
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
// If --slurm is given, submits a job array instead and writes one line of JSON, {job, script,
// runs}, to stdout. Returns 0 unless Slurm refuses.
int RunExperiment(const ExperimentOptions& options);

// Executes one run; output and exit code are those of RunExperiment. Any number of processes may do
// so for one experiment, on any hosts that share its folder. Throws Error: no experiment in the
// folder, no such run, or a command runs the whole experiment.
int RunExperimentTask(const ExperimentTask& task);

}  // namespace shoal::launch
