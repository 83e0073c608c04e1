// SPDX-License-Identifier: Apache-2.0
// The folder of an experiment:
//
//   experiment.json   the definition and the base as it was resolved at the first run: both hold
//   configs/ARM.json  what `shoal train` of an arm is given
//   runs/ARM-sSEED/   the runs, each an ordinary run folder
//   logs/ARM-sSEED.log  what `shoal train` said
//   runs.jsonl        when which run was started and how that ended (run_log.h)
//   summary.json      after every run (summary.h)
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
  size_t arm = 0;  // in the definition
  int64_t seed = 0;
  std::string name{};              // ARM-sSEED
  std::filesystem::path folder{};  // of the run
};

// An experiment as its folder holds it. Reads only.
struct StoredExperiment {
  std::filesystem::path folder{};
  Definition definition{};
  Config base{};
  std::string created{};  // UTC

  // Arms x seeds, seed by seed, so that an experiment cut short has whole comparisons.
  std::vector<ExperimentRun> Runs(const std::vector<int64_t>& seeds) const;
  // "ARM-sSEED" of any seed; empty where there is no such arm.
  std::optional<ExperimentRun> RunNamed(const std::string& name) const;
  // Runs of every seed that the definition names and of every seed that has a run: in its folder,
  // or, if it failed before it had one, in the log. Throws Error on a broken log.
  std::vector<ExperimentRun> Runs() const;
  // How one of them stands, its evaluations on further tasks included; `log` as Log().Read() gives
  // it.
  StandingReport Standing(const ExperimentRun& run,
                          const std::map<std::string, LoggedRun>& log) const;
  std::filesystem::path LogFile(const ExperimentRun& run) const;
  RunLog Log() const { return RunLog(folder / "runs.jsonl"); }
};

// Throws Error: no experiment.json, or a broken one.
StoredExperiment ReadExperiment(const std::filesystem::path& folder);

// Experiments as commands take them: by name within `dir`, or by folder (FindNamed).
NamedKind ExperimentsIn(const std::filesystem::path& dir = "experiments");
// Whether the folder holds an experiment.
bool IsExperiment(const std::filesystem::path& folder);

// An experiment that may be run: every arm has been checked, and so has the folder.
struct ExperimentPlan {
  StoredExperiment experiment{};  // with the definition that was asked for
  std::vector<Config> arms{};     // resolved, in the order of the definition
  std::string source{};           // of the definition, for errors
};

// Writes nothing. Throws Error (usage) where an arm or a further task is refused, or the folder
// holds something else than an experiment or another one: another name, base, `set`,
// final_episodes or first arm, an arm of that name with other keys, or an arm that is no longer
// asked for. What else may differ takes the place of what was there.
ExperimentPlan PlanExperiment(const std::filesystem::path& folder, const Definition& definition,
                              const std::string& source);

// Holds an experiment against a second command until destruction (or death).
class ExperimentFolder {
 public:
  // Makes the folder, or opens the one that is there. Throws Error (usage) before anything else is
  // written where another process runs it, or has made another experiment of it since the plan.
  explicit ExperimentFolder(const ExperimentPlan& plan);

  const StoredExperiment& experiment() const { return experiment_; }

 private:
  StoredExperiment experiment_;
  std::optional<FileLock> lock_;
};

// Holds an experiment together with others that do single runs of it, on any host, against a
// command that runs it whole.
class ExperimentShare {
 public:
  // Waits a minute for the command that submits such runs. Throws Error (usage): no experiment
  // there, or a command runs it whole.
  explicit ExperimentShare(const std::filesystem::path& folder);

  const StoredExperiment& experiment() const { return experiment_; }

 private:
  FileLock lock_;
  StoredExperiment experiment_;
};

// Whether a process runs the experiment of this folder, or a run of it.
bool IsExperimentHeld(const std::filesystem::path& folder);

}  // namespace shoal::launch
