// SPDX-License-Identifier: Apache-2.0
// Subjects of comparisons, plots and reports: runs and experiments, by name or folder.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "launch/tools/experiment/experiment_folder.h"
#include "launch/tools/experiment/run_results.h"

namespace shoal::launch {

// Runs that differ in their seeds alone: an arm, or one run that was named.
struct RunGroup {
  std::string name{};
  std::vector<RunResults> runs{};          // those that were evaluated, failed ones too
  std::vector<std::string> unevaluated{};  // of an arm: runs that have not come so far, by name
  std::vector<std::string> unfinished{};   // of `runs`: those with something still to be done
  std::vector<std::string> failed{};       // runs that failed, of `runs` or not evaluated
};

struct SubjectOptions {
  std::vector<std::string> names;  // of runs or experiments: name, or folder
  std::string run_dir = "runs";
  std::string experiment_dir = "experiments";
};

// One name on the command line.
struct Subject {
  std::string name{};                            // of its folder
  std::optional<StoredExperiment> experiment{};  // empty: a run
};

struct Subjects {
  std::vector<Subject> named{};  // in the order given
  // Groups of all subjects: one per arm of an experiment (EXPERIMENT/ARM if there is more than one
  // subject) and one per run.
  std::vector<RunGroup> groups{};
};

// Throws Error (usage) naming a subject that is neither run nor experiment, is given twice or has
// no evaluation.
Subjects ReadSubjects(const SubjectOptions& options);

// Throws Error (usage) naming two runs of different tasks: their figures do not compare.
void CheckOneTask(const std::vector<RunGroup>& groups);

}  // namespace shoal::launch
