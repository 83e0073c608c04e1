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
#include "launch/tools/experiment/run_results.h"
#include "launch/tools/experiment/seed_figures.h"
#include "launch/tools/experiment/statistics.h"

namespace shoal::launch {

struct RunOutcome {
  ExperimentRun run{};
  StandingReport report{};
  LoggedRun logged{};
  std::optional<RunResults> results{};    // empty: not begun, or unreadable
  std::optional<uint64_t> n_to_target{};  // env steps
};

struct ArmOutcome {
  std::string name{};
  std::vector<RunOutcome> runs{};  // by seed, in the order of the seeds
  SeedFigures figures{};           // of the final evaluations of the finished runs
};

// A world with baselines of its own: a task with its threshold, model file, physics and action
// repeat.
struct JudgedWorld {
  enum class Kind {
    kFirst,      // of the first arm
    kOtherTask,  // the first of its task: of a further arm, or that policies are tested on
    kOtherArm,   // of a task there is already, otherwise set up by an arm
  };
  Kind kind = Kind::kFirst;
  std::string name{};  // of the task; of the arm where it is kOtherArm
  Config config{};
};

// One for each, the first arm's first.
std::vector<JudgedWorld> JudgedWorlds(const StoredExperiment& experiment);

struct ExperimentOutcome {
  StoredExperiment experiment{};
  std::vector<ArmOutcome> arms{};
  // n_to_target of an arm and of the first one, seed by seed: for each arm but the first, where the
  // task has a success.
  struct NamedRatio {
    std::string arm, first;
    SampleRatio ratio;
  };
  std::vector<NamedRatio> ratios{};
  // Baselines of each world in which an arm trains or is tested; only those already measured.
  struct NamedBaselines {
    JudgedWorld world;
    Baselines baselines;
  };
  std::vector<NamedBaselines> baselines{};
};

// Reads every run. Throws Error only for a broken experiment.json or log: a broken run is a failed
// one.
ExperimentOutcome ReadOutcome(const StoredExperiment& experiment);

nlohmann::ordered_json ToJson(const ExperimentOutcome& outcome);

// summary.json of the experiment's folder, replaced atomically. Throws Error.
void WriteSummary(const ExperimentOutcome& outcome);

// For people: what was asked, a line per arm, the ratios, what is missing.
std::string SummaryText(const ExperimentOutcome& outcome);
// A line per run: how it stands and how far it came.
std::string StatusText(const ExperimentOutcome& outcome);

}  // namespace shoal::launch
