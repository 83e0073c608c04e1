// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/slurm_array.h"

#include <fmt/core.h>

#include "common/base/bounded_json.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/stop.h"
#include "common/run_folder/run_file_names.h"
#include "launch/processes/child_process.h"
#include "launch/processes/process_plan.h"
#include "launch/processes/remote_host.h"
#include "launch/processes/scratch_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

constexpr char kArraySchema[] = "shoal-slurm-array-1";
constexpr std::chrono::seconds kSlurmAnswers{60};

struct Answer {
  bool good = false;
  std::string said{};  // last line of the output
};

// Runs a program of Slurm, found through the user's PATH.
Answer Ask(std::vector<std::string> command) {
  command.insert(command.begin(), "/usr/bin/env");
  const ScratchFolder scratch;
  ProcessSpec spec;
  spec.role = command[1];
  spec.output = scratch.path() / "said";
  spec.errors = scratch.path() / "errors";  // keeps warnings out of the answer
  spec.command = std::move(command);
  const auto status = RunToEnd(spec, kSlurmAnswers, StopRequested);
  if (!status) return {.good = false, .said = "no answer within a minute"};
  if (status->Clean()) return {.good = true, .said = LastLine(spec.output)};
  const std::string why = LastLine(spec.errors);
  return {.good = false, .said = why.empty() ? LastLine(spec.output) : why};
}

// Null if no array was submitted yet.
ordered_json LastArray(const fs::path& file) {
  std::error_code error;
  if (!fs::exists(file, error)) return nullptr;
  auto array = ParseBoundedJson<ordered_json>(ReadFile(file));
  if (!array.is_object() || array.value("schema", "") != kArraySchema || !array.contains("job") ||
      !array["job"].is_string()) {
    throw RuntimeError("{}: expected an object of schema '{}'", file.string(), kArraySchema);
  }
  return array;
}

// A task that was submitted twice would occupy a place of its own while it waits for the first one.
void RefuseWhileQueued(const fs::path& folder) {
  const ordered_json last = LastArray(folder / "slurm.json");
  if (last.is_null()) return;
  const auto job = last["job"].get<std::string>();
  const Answer queue = Ask({"squeue", "--noheader", "--format=%i", "--jobs=" + job});
  if (queue.good && !queue.said.empty()) {  // for a job that has ended long ago, squeue fails
    throw UsageError(
        "job {} of experiment '{}' is still queued or running: wait for it, or "
        "scancel {}",
        job, folder.string(), job);
  }
}

}  // namespace

ordered_json ToJson(const SlurmArray& array) {
  return {{"job", array.job}, {"script", array.script.string()}, {"runs", array.runs}};
}

std::vector<ExperimentRun> StillToBeDone(const StoredExperiment& experiment,
                                         const std::vector<ExperimentRun>& runs,
                                         bool retry_failed) {
  const auto log = experiment.Log().Read();
  std::vector<ExperimentRun> missing;
  for (const ExperimentRun& run : runs) {
    const ExperimentRunStatus standing = experiment.Standing(run, log).standing;
    if (standing == ExperimentRunStatus::kMissing ||
        standing == ExperimentRunStatus::kInterrupted ||
        (standing == ExperimentRunStatus::kFailed && retry_failed)) {
      missing.push_back(run);
    }
  }
  return missing;
}

std::string ArrayScript(const StoredExperiment& experiment, const std::vector<ExperimentRun>& runs,
                        const ArrayTerms& terms, const fs::path& program) {
  std::vector<std::string> names;
  names.reserve(runs.size());
  for (const ExperimentRun& run : runs) names.push_back(run.name);
  const size_t at_once =
      terms.at_once ? std::min<size_t>(*terms.at_once, runs.size()) : runs.size();
  // Before its time limit the task gets SIGINT. The shell has been replaced by shoal, which stops
  // in order.
  return fmt::format(
      "#!/usr/bin/env bash\n"
      "# One run of the experiment a task; written by `shoal experiment run --slurm`.\n"
      "#SBATCH --array=0-{last}%{at_once}\n"
      "#SBATCH --cpus-per-task=2\n"
      "#SBATCH --signal=B:INT@120\n"
      "set -euo pipefail\n"
      "runs=({runs})\n"
      "exec {command} \"${{runs[$SLURM_ARRAY_TASK_ID]}}\" --side-by-side {at_once} "
      "--retry-failed\n",
      fmt::arg("last", runs.size() - 1), fmt::arg("at_once", at_once),
      fmt::arg("runs", ShellLine(names)),
      fmt::arg("command",
               ShellLine({program.string(), "experiment", "task", experiment.folder.string()})));
}

SlurmArray SubmitArray(const StoredExperiment& experiment, const std::vector<ExperimentRun>& runs,
                       const ArrayTerms& terms) {
  RefuseWhileQueued(experiment.folder);
  SlurmArray array{.script = experiment.folder / "slurm.sbatch"};
  for (const ExperimentRun& run : runs) array.runs.push_back(run.name);
  WriteFileAtomically(array.script,
                      ArrayScript(experiment, runs, terms, ProgramFolder() / "shoal"));
  std::vector<std::string> command{
      "sbatch", "--parsable", "--job-name=shoal-" + experiment.definition.name,
      fmt::format("--output={}/slurm-%A_%a.log", (experiment.folder / kLogFolder).string())};
  command.insert(command.end(), terms.sbatch_options.begin(), terms.sbatch_options.end());
  command.push_back(array.script.string());
  const Answer answer = Ask(std::move(command));
  if (!answer.good) throw RuntimeError("sbatch {}: {}", array.script.string(), answer.said);
  array.job = answer.said.substr(0, answer.said.find(';'));  // JOB or JOB;CLUSTER
  ordered_json note = ToJson(array);
  note["schema"] = kArraySchema;
  note["submitted"] = UtcTimestamp();
  WriteFileAtomically(experiment.folder / "slurm.json", note.dump(2) + "\n");
  return array;
}

}  // namespace shoal::launch
