// SPDX-License-Identifier: Apache-2.0
// `shoal compare`: groups of runs side by side. Seeds are the unit (statistics.h).
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "launch/run/baselines.h"
#include "launch/tools/experiment/seed_figures.h"
#include "launch/tools/experiment/statistics.h"
#include "launch/tools/report/subjects.h"

namespace shoal::launch {

struct GroupFigures {
  std::string name{};
  std::vector<int64_t> seeds{};
  std::vector<bool> over{};  // by seed: finished or failed
  // Figures of the final evaluation of each run, or of its last one if it has not ended. A failed
  // run is only counted, unless it is the whole group.
  SeedFigures figures{};
  std::vector<std::string> without_final{};  // runs judged by their last evaluation
  std::vector<std::string> failed{};
  std::vector<std::string> unevaluated{};
  // Env steps, by seed; empty = not reached, or, where the run is not over, not yet.
  std::vector<std::optional<double>> n_to_target{};
  std::vector<std::optional<double>> seconds_to_target{};      // of wall clock, likewise
  std::vector<double> env_steps{}, updates{}, wall_seconds{};  // by seed
  double core_hours = 0;  // of all seeds: wall time x usable cores
};

struct KeyDifference {
  std::string key{};
  std::vector<std::string> values{};  // as JSON, one per group; "-" of a group without runs
};

struct Comparison {
  std::string task{};
  double target_success = 0.9;
  std::vector<GroupFigures> groups{};
  // Ratios of each further group to the first, over the seeds whose runs are over in both.
  std::vector<SampleRatio> ratios{};
  std::vector<KeyDifference> differences{};
  std::optional<Baselines> baselines{};  // empty where they have not been measured
};

// Throws Error (usage) on mixed tasks.
Comparison Compare(const std::vector<RunGroup>& groups, double target_success);
// The same where tasks may be mixed, as in an experiment about transfer: `task` and the baselines
// are then those of the first group.
Comparison Gather(const std::vector<RunGroup>& groups, double target_success);

// Schema shoal-comparison-1; docs/experiments.md.
nlohmann::ordered_json ToJson(const Comparison& comparison);
std::string ToText(const Comparison& comparison);

// "3", "2, 1 failed": seeds that a group's figures are of, and those that failed; "1, failed" of a
// failed run by itself.
std::string FormatSeeds(const GroupFigures& group);
// Env steps and wall clock to the target, by seed: "1200 (35 s), not reached, not yet"; "-" without
// runs.
std::string FormatSteps(const GroupFigures& group);

// Configuration keys in which the groups differ; those that only name a run are left out.
std::vector<KeyDifference> FindDifferences(const std::vector<RunGroup>& groups);

}  // namespace shoal::launch
