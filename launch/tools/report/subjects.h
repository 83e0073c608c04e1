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

// Runs that differ only in their seeds: the runs of an arm, or one named run.
struct RunGroup {
  std::string name{};
  std::vector<RunResults> runs{};          // runs with an evaluation, including failed runs
  std::vector<std::string> unevaluated{};  // names of an arm's runs without an evaluation yet
  std::vector<std::string> unfinished{};   // names of those `runs` that are not finished
  std::vector<std::string> failed{};       // names of failed runs, with or without an evaluation
};

struct SubjectOptions {
  std::vector<std::string> names;  // of runs or experiments: name, or folder
  std::string run_dir = "runs";
  std::string experiment_dir = "experiments";
};

// One name on the command line.
struct Subject {
  std::string name{};                            // name of the folder
  std::optional<StoredExperiment> experiment{};  // empty if the subject is a run
};

struct Subjects {
  std::vector<Subject> named{};  // in the order given
  // Groups of all subjects: one per arm of an experiment (EXPERIMENT/ARM if there is more than one
  // subject) and one per run.
  std::vector<RunGroup> groups{};
};

// Reads the subjects. Throws Error (usage) naming a subject that is neither a run nor an
// experiment, occurs twice or has no evaluation.
Subjects ReadSubjects(const SubjectOptions& options);

// Tasks of the runs, each once, in the order of the groups.
std::vector<std::string> TasksOf(const std::vector<RunGroup>& groups);

// Throws Error (usage) naming two runs of different tasks, whose results cannot be compared.
void CheckOneTask(const std::vector<RunGroup>& groups);

}  // namespace shoal::launch
