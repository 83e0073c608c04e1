// SPDX-License-Identifier: Apache-2.0
// Summary of an experiment so far: summary.json (schema shoal-experiment-1) and the table of `shoal
// experiment summary`. docs/experiments.md explains each member.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "launch/run/baselines.h"
#include "launch/tools/experiment/experiment_folder.h"
#include "launch/tools/experiment/experiment_run_status.h"
#include "launch/tools/experiment/frames_results.h"
#include "launch/tools/experiment/run_results.h"
#include "launch/tools/experiment/seed_figures.h"
#include "launch/tools/experiment/statistics.h"

namespace shoal::launch {

struct RunOutcome {
  ExperimentRun run{};
  StandingReport report{};
  LoggedRun logged{};
  std::optional<RunResults> results{};      // empty: not started, or unreadable
  std::optional<uint64_t> n_to_target{};    // env steps
  std::vector<ReturnAtFrames> at_frames{};  // at the definition's `frames`; empty for a failed run
};

struct ArmOutcome {
  std::string name{};
  std::vector<RunOutcome> runs{};  // by seed, in the order of the seeds
  SeedFigures figures{};           // results of the final evaluations of the finished runs
};

// A world with its own baselines: a task with its threshold, model file, physics and action repeat.
struct JudgedWorld {
  enum class Kind {
    kFirst,      // the world of the first arm
    kOtherTask,  // another task: of a further arm, or of an evaluation on a further task
    kOtherArm,   // a task that is listed already, with other settings of an arm
  };
  Kind kind = Kind::kFirst;
  std::string name{};  // name of the task; kOtherArm: name of the arm
  Config config{};
};

// One entry for each world, beginning with the world of the first arm.
std::vector<JudgedWorld> JudgedWorlds(const StoredExperiment& experiment);

struct ExperimentOutcome {
  StoredExperiment experiment{};
  std::vector<ArmOutcome> arms{};
  // Ratio of n_to_target between an arm and the first arm, seed by seed. One entry for each arm
  // except the first; empty if the task has no success.
  struct NamedRatio {
    std::string arm, first;
    SampleRatio ratio;
  };
  std::vector<NamedRatio> ratios{};
  // Baselines of each world in which an arm trains or is tested; worlds that are not measured yet
  // are left out.
  struct NamedBaselines {
    JudgedWorld world;
    Baselines baselines;
  };
  std::vector<NamedBaselines> baselines{};
  FramesResults frames{};           // without frames if the definition has none
  std::string reference_problem{};  // why the definition's reference is not in `frames`
};

// Reads every run. A broken run counts as failed. Throws Error only if experiment.json or the log
// is broken.
ExperimentOutcome ReadOutcome(const StoredExperiment& experiment);

nlohmann::ordered_json ToJson(const ExperimentOutcome& outcome);

// Writes summary.json in the experiment's folder atomically. Throws Error.
void WriteSummary(const ExperimentOutcome& outcome);

// Text for the terminal: the question, a line per arm, the ratios, the missing runs.
std::string SummaryText(const ExperimentOutcome& outcome);
// Text for the terminal: a line per run with its status and progress.
std::string StatusText(const ExperimentOutcome& outcome);

}  // namespace shoal::launch
