// SPDX-License-Identifier: Apache-2.0
// Runs of an experiment as a Slurm job array, one run per task. Slurm places the tasks; each task
// calls `shoal experiment task`.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "launch/tools/experiment/experiment_folder.h"

namespace shoal::launch {

struct ArrayTerms {
  std::optional<int> at_once{};               // most tasks at a time; empty = no limit
  std::vector<std::string> sbatch_options{};  // for sbatch; they override the script's options
};

struct SlurmArray {
  std::string job{};  // number of the job in Slurm
  std::filesystem::path script{};
  std::vector<std::string> runs{};  // in the order of the tasks
};
nlohmann::ordered_json ToJson(const SlurmArray& array);

// The runs among `runs` that an array would execute: missing and interrupted runs and, if
// `retry_failed`, failed runs.
std::vector<ExperimentRun> StillToBeDone(const StoredExperiment& experiment,
                                         const std::vector<ExperimentRun>& runs, bool retry_failed);

// The sbatch script of an array of these runs. `program`: path of shoal in the tasks' commands.
std::string ArrayScript(const StoredExperiment& experiment, const std::vector<ExperimentRun>& runs,
                        const ArrayTerms& terms, const std::filesystem::path& program);

// Writes the script into the experiment's folder (slurm.sbatch), submits the script with sbatch and
// records the job in slurm.json. Waits a minute at most for Slurm. Throws Error if tasks of an
// earlier array are still queued or running, if sbatch is missing, or if sbatch refuses the script.
SlurmArray SubmitArray(const StoredExperiment& experiment, const std::vector<ExperimentRun>& runs,
                       const ArrayTerms& terms);

}  // namespace shoal::launch
