// What comparisons, plots and reports are about: runs and experiments, by name or folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "launch/experiment/run_results.h"

namespace shoal::launch {

// Runs that differ in their seeds alone: an arm, or one run that was named.
struct RunGroup {
  std::string name{};
  std::vector<RunResults> runs{};          // those that were evaluated
  std::vector<std::string> unevaluated{};  // of an arm: runs that have not come so far, by name
};

struct SubjectOptions {
  std::vector<std::string> names;  // of runs or experiments: name, or folder
  std::string run_dir = "runs";
  std::string experiment_dir = "experiments";
};

// A group per arm of an experiment (EXPERIMENT/ARM where more than one subject is given) and per
// run, in the order given. Throws Error (usage) naming a subject that is neither, is given twice or
// has no evaluation.
std::vector<RunGroup> ReadSubjects(const SubjectOptions& options);

// Throws Error (usage) naming two runs of different tasks: their figures do not compare.
void CheckOneTask(const std::vector<RunGroup>& groups);

}  // namespace shoal::launch
