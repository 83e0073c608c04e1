// SPDX-License-Identifier: Apache-2.0
// The folder of an experiment:
//
//   experiment.json   the definition, and the base as resolved at the first run; both are binding
//   configs/ARM.json  configuration of `shoal train` for an arm
//   runs/ARM-sSEED/   the runs, each an ordinary run folder
//   logs/ARM-sSEED.log  output of `shoal train`
//   runs.jsonl        starts and ends of the runs (run_log.h)
//   summary.json      rewritten after every run (summary.h)
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/file_lock.h"
#include "launch/record/run_folder.h"
#include "launch/tools/experiment/definition.h"
#include "launch/tools/experiment/experiment_run_status.h"
#include "launch/tools/experiment/run_log.h"

namespace shoal::launch {

struct ExperimentRun {
  size_t arm = 0;  // index in the definition
  int64_t seed = 0;
  std::string name{};              // ARM-sSEED
  std::filesystem::path folder{};  // of the run
};

// An experiment as stored in its folder. Only reads the folder.
struct StoredExperiment {
  std::filesystem::path folder{};
  Definition definition{};
  Config base{};
  std::string created{};  // UTC

  // Runs ordered by seed, then by arm, so that an experiment that is stopped early has complete
  // comparisons.
  std::vector<ExperimentRun> Runs(const std::vector<int64_t>& seeds) const;
  // The run named "ARM-sSEED", for any seed; empty if there is no such arm.
  std::optional<ExperimentRun> RunNamed(const std::string& name) const;
  // Runs of every seed of the definition, and of every other seed that has a run in the folder or
  // in the log (a run may fail before its folder exists). Throws Error if the log is broken.
  std::vector<ExperimentRun> Runs() const;
  // Status of a run, including its evaluations on further tasks. `log`: result of Log().Read().
  StandingReport Standing(const ExperimentRun& run,
                          const std::map<std::string, LoggedRun>& log) const;
  std::filesystem::path LogFile(const ExperimentRun& run) const;
  RunLog Log() const { return RunLog(folder / "runs.jsonl"); }
};

// The experiment with only the arms of these runs.
StoredExperiment WithArmsOf(const std::vector<ExperimentRun>& runs, StoredExperiment experiment);

// Reads the experiment. Throws Error if experiment.json is missing or broken.
StoredExperiment ReadExperiment(const std::filesystem::path& folder);

// The kind of folder with which FindNamed finds experiments: by name within `dir`, or by path.
NamedKind ExperimentsIn(const std::filesystem::path& dir = "experiments");
// Whether the folder holds an experiment.
bool IsExperiment(const std::filesystem::path& folder);

// An experiment that may be executed: every arm and the folder have been checked.
struct ExperimentPlan {
  StoredExperiment experiment{};  // with the requested definition
  std::vector<Config> arms{};     // resolved, in the order of the definition
  std::string source{};           // name of the definition, for errors
};

// Checks the arms and the folder; writes nothing. Throws Error (usage) if an arm or a further task
// is refused, if the folder holds something other than an experiment, or if the folder holds an
// incompatible experiment: another name, base, `set`, final_episodes or first arm, an arm of the
// same name with other keys, or an arm that the definition no longer has. If other members differ,
// the new values replace the stored values.
ExperimentPlan PlanExperiment(const std::filesystem::path& folder, const Definition& definition,
                              const std::string& source);

// Locks an experiment against a second command, until destruction or the death of the process.
class ExperimentFolder {
 public:
  // Creates the folder, or opens the existing folder. Throws Error (usage), before any other file
  // is written, if another process executes the experiment or has changed the experiment since the
  // plan was made.
  explicit ExperimentFolder(const ExperimentPlan& plan);

  const StoredExperiment& experiment() const { return experiment_; }

 private:
  StoredExperiment experiment_;
  std::optional<FileLock> lock_;
};

// Shared lock on an experiment. Processes on any host may execute single runs at the same time, but
// no command may execute the whole experiment during this time.
class ExperimentShare {
 public:
  // Waits up to a minute for the command that submits such runs. Throws Error (usage) if there is
  // no experiment in the folder, or if a command executes the whole experiment.
  explicit ExperimentShare(const std::filesystem::path& folder);

  const StoredExperiment& experiment() const { return experiment_; }

 private:
  FileLock lock_;
  StoredExperiment experiment_;
};

// Whether a process executes the experiment of this folder, or a single run of the experiment.
bool IsExperimentHeld(const std::filesystem::path& folder);

}  // namespace shoal::launch
