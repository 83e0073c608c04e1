// SPDX-License-Identifier: Apache-2.0
// `shoal compare`: compares groups of runs. The unit of the statistics is the seed (statistics.h).
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
  std::vector<bool> over{};  // by seed: the run is finished or failed
  // Results of the final evaluation of each run, or of the last evaluation if the run has not
  // ended. Failed runs are only counted, unless the group has no other run.
  SeedFigures figures{};
  std::vector<std::string> without_final{};  // runs judged by their last evaluation
  std::vector<std::string> failed{};
  std::vector<std::string> unevaluated{};
  // Env steps to the target, by seed; empty = not reached, or not reached yet if the run is not
  // over.
  std::vector<std::optional<double>> n_to_target{};
  std::vector<std::optional<double>> seconds_to_target{};  // wall clock, by seed; empty likewise
  std::vector<double> env_steps{}, updates{}, wall_seconds{};  // by seed
  double core_hours = 0;  // wall time x usable cores, summed over all seeds
};

struct KeyDifference {
  std::string key{};
  std::vector<std::string> values{};  // as JSON, one per group; "-" for a group without runs
};

struct Comparison {
  std::string task{};
  double target_success = 0.9;
  std::vector<GroupFigures> groups{};
  // Ratio of each further group to the first group, over the seeds whose runs are over in both
  // groups.
  std::vector<SampleRatio> ratios{};
  std::vector<KeyDifference> differences{};
  std::optional<Baselines> baselines{};  // empty if not measured
};

// Compares the groups. Throws Error (usage) if their tasks differ.
Comparison Compare(const std::vector<RunGroup>& groups, double target_success);
// Compares groups whose tasks may differ, as in an experiment about transfer. `task` and the
// baselines are those of the first group.
Comparison Gather(const std::vector<RunGroup>& groups, double target_success);

// Schema shoal-comparison-1; docs/experiments.md.
nlohmann::ordered_json ToJson(const Comparison& comparison);
std::string ToText(const Comparison& comparison);

// Number of seeds in a group's results, and number of failed seeds: "3", "2, 1 failed"; "1, failed"
// for a single failed run.
std::string FormatSeeds(const GroupFigures& group);
// Env steps and wall clock to the target, by seed: "1200 (35 s), not reached, not yet"; "-" without
// runs.
std::string FormatSteps(const GroupFigures& group);

// Configuration keys with different values in the groups, except keys that only name a run.
std::vector<KeyDifference> FindDifferences(const std::vector<RunGroup>& groups);

}  // namespace shoal::launch
