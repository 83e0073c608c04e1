// What an experiment has shown so far: summary.json (schema shoal-experiment-1) and the table of
// `shoal experiment summary`. docs/experiments.md explains each member.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "launch/experiment/baselines.h"
#include "launch/experiment/experiment_folder.h"
#include "launch/experiment/run_results.h"
#include "launch/experiment/run_standing.h"
#include "launch/experiment/statistics.h"

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
  // Over the final evaluations of the finished runs.
  uint64_t successes = 0, episodes = 0;  // pooled; no episodes where the task has no success
  std::vector<double> returns{};         // mean return of each run
  std::vector<double> distances{};       // mean final distance of each run, m
};

struct ExperimentOutcome {
  StoredExperiment experiment{};
  std::vector<ArmOutcome> arms{};
  // n_to_target of an arm and of the first one, seed by seed: for each arm but the first, where the
  // task has a success.
  struct NamedRatio {
    std::string name;  // "ARM/FIRST"
    SampleRatio ratio;
  };
  std::vector<NamedRatio> ratios{};
  // Of each task that an arm trains on or is tested on, by task; only what has been measured.
  std::vector<std::pair<std::string, Baselines>> baselines{};
};

// A configuration for each task that an arm trains on or is tested on: what baselines are of.
std::vector<Config> JudgedConfigs(const StoredExperiment& experiment);

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

// "97.3 % [94.1, 98.9] (292/300)"; "-" without episodes.
std::string FormatPooled(uint64_t successes, uint64_t episodes);
// "-0.82 [-0.91, -0.73] (3 seeds)"; the mean alone of one seed; "-" without any.
std::string FormatMean(const std::vector<double>& values, int digits);

}  // namespace shoal::launch
