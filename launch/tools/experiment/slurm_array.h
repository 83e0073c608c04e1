// SPDX-License-Identifier: Apache-2.0
// The runs of an experiment as a Slurm job array, one run a task: Slurm places them, each does
// `shoal experiment task`.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "launch/tools/experiment/experiment_folder.h"

namespace shoal::launch {

struct ArrayTerms {
  std::optional<int> at_once{};               // tasks that Slurm may run at a time; empty = any
  std::vector<std::string> sbatch_options{};  // as sbatch takes them; over those of the script
};

struct SlurmArray {
  std::string job{};  // Slurm's number
  std::filesystem::path script{};
  std::vector<std::string> runs{};  // in the order of the tasks
};
nlohmann::ordered_json ToJson(const SlurmArray& array);

// The runs among `runs` that an array would do: missing or interrupted ones, and failed ones on
// request.
std::vector<ExperimentRun> StillToBeDone(const StoredExperiment& experiment,
                                         const std::vector<ExperimentRun>& runs, bool retry_failed);

// The script of an array of these runs, with `program` (shoal) as its tasks call it.
std::string ArrayScript(const StoredExperiment& experiment, const std::vector<ExperimentRun>& runs,
                        const ArrayTerms& terms, const std::filesystem::path& program);

// Writes the script into the experiment's folder (slurm.sbatch), submits it with sbatch and notes
// the job in slurm.json. Throws Error: tasks of the array that was submitted before are still
// queued or running, there is no sbatch, or it refuses. Waits for Slurm a minute at most.
SlurmArray SubmitArray(const StoredExperiment& experiment, const std::vector<ExperimentRun>& runs,
                       const ArrayTerms& terms);

}  // namespace shoal::launch
