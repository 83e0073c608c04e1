// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/report/compare.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "common/base/bounded_json.h"
#include "common/base/build_info.h"
#include "common/base/or_null.h"
#include "common/config/config_io.h"
#include "launch/tools/experiment/aligned_table.h"
#include "launch/tools/experiment/statistics_json.h"

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;

constexpr std::array kNamesOfRuns = {"preset", "seed", "run_name", "run_dir"};

void Flatten(const ordered_json& object, const std::string& prefix,
             std::vector<std::pair<std::string, std::string>>* keys) {
  for (const auto& [name, value] : object.items()) {
    const std::string path = prefix.empty() ? name : prefix + "." + name;
    // Sections are one level deep; an object below this level is a value.
    if (prefix.empty() && value.is_object()) {
      Flatten(value, path, keys);
    } else {
      keys->emplace_back(path, value.dump());
    }
  }
}

std::vector<std::pair<std::string, std::string>> KeysOf(const Config& config) {
  std::vector<std::pair<std::string, std::string>> keys;
  Flatten(ToJson(config), "", &keys);
  return keys;
}

void Judge(const RunResults& run, GroupFigures* figures) {
  const EvaluationFigures& judged = run.final ? *run.final : run.curve.back();
  if (!run.final) figures->without_final.push_back(run.name);
  figures->figures.Add(judged.success, judged.episodes, judged.return_mean,
                       judged.final_distance_mean);
}

GroupFigures FiguresOf(const RunGroup& group, double target_success) {
  GroupFigures figures{.name = group.name};
  figures.failed = group.failed;
  figures.unevaluated = group.unevaluated;
  // If a failed run is the only run of its group, show its figures: the group has no others.
  const bool alone = group.runs.size() == 1 && group.failed == std::vector{group.runs[0].name} &&
                     group.unevaluated.empty();
  figures.figures.failed = alone ? 0 : group.failed.size();
  for (const RunResults& run : group.runs) {
    if (alone || std::ranges::count(group.failed, run.name) == 0) Judge(run, &figures);
    figures.seeds.push_back(run.config.seed);
    figures.over.push_back(std::ranges::count(group.unfinished, run.name) == 0);
    const EvaluationFigures* first = FirstReaching(run, target_success);
    figures.n_to_target.emplace_back();
    figures.seconds_to_target.emplace_back();
    if (first != nullptr) {
      figures.n_to_target.back() = static_cast<double>(first->env_steps);
      figures.seconds_to_target.back() = first->wall_seconds;
    }
    figures.env_steps.push_back(static_cast<double>(run.env_steps));
    figures.updates.push_back(static_cast<double>(run.updates));
    figures.wall_seconds.push_back(run.wall_seconds);
    figures.core_hours += run.wall_seconds * run.cores / 3600;
  }
  return figures;
}

std::vector<TargetReached> TargetsOf(const GroupFigures& group) {
  std::vector<TargetReached> targets;
  for (size_t i = 0; i < group.seeds.size(); ++i) {
    targets.push_back({group.seeds[i], group.over[i], group.n_to_target[i]});
  }
  return targets;
}

std::optional<Interval> IqmInterval95(const std::vector<double>& values) {
  return StratifiedBootstrap95({values}, InterquartileMean);
}

// Adds the members that only comparisons have to the object of a mean: bootstrap95 of the mean, and
// the interquartile mean with its own interval.
ordered_json WithIqm(ordered_json object, const std::vector<double>& values) {
  const auto iqm = values.empty() ? std::nullopt : std::optional(InterquartileMean(values));
  object["bootstrap95"] = IntervalJson(BootstrapInterval95(values));
  object["iqm"] = OrNull(iqm);
  object["iqm95"] = IntervalJson(IqmInterval95(values));
  return object;
}

ordered_json GroupJson(const GroupFigures& group) {
  const auto by_seed = [](const std::vector<std::optional<double>>& values) {
    ordered_json array = ordered_json::array();
    for (const auto& value : values) array.push_back(OrNull(value));
    return array;
  };
  const SeedFigures& figures = group.figures;
  return {{"name", group.name},
          {"seeds", group.seeds},
          {"success", WithIqm(SuccessJson(figures), figures.Rates())},
          {"return", WithIqm(ReturnJson(figures), figures.returns)},
          {"final_distance", WithIqm(DistanceJson(figures), figures.distances)},
          {"n_to_target", by_seed(group.n_to_target)},
          {"seconds_to_target", by_seed(group.seconds_to_target)},
          {"env_steps", group.env_steps},
          {"updates", group.updates},
          {"wall_seconds", group.wall_seconds},
          {"core_hours", group.core_hours},
          {"without_final_evaluation", group.without_final},
          {"failed", group.failed},
          {"without_evaluation", group.unevaluated}};
}

std::string FormatCounts(const std::vector<double>& values) {
  return values.empty() ? "-" : fmt::format("{:.0f}", Mean(values));
}

std::string Notes(const Comparison& comparison) {
  std::string notes;
  for (const GroupFigures& group : comparison.groups) {
    if (!group.without_final.empty()) {
      notes += fmt::format("no final evaluation yet, so the last evaluation counts: {}\n",
                           fmt::join(group.without_final, ", "));
    }
    if (!group.failed.empty()) {
      notes += fmt::format("failed: {}\n", fmt::join(group.failed, ", "));
    }
    if (!group.unevaluated.empty()) {
      notes += fmt::format("no evaluation, not in the figures: {}\n",
                           fmt::join(group.unevaluated, ", "));
    }
  }
  return notes;
}

// The interquartile mean of fewer than four seeds equals the mean.
bool HasIqm(const GroupFigures& group) { return group.figures.returns.size() >= 4; }

// One line for each group with enough seeds.
std::string Iqms(const Comparison& comparison) {
  std::string text;
  for (const GroupFigures& group : comparison.groups) {
    if (!HasIqm(group)) continue;
    const bool success = !group.figures.successes.empty();
    std::vector<double> values = success ? group.figures.Rates() : group.figures.returns;
    if (success) std::ranges::transform(values, values.begin(), [](double r) { return 100 * r; });
    const Interval interval = *IqmInterval95(values);
    text += fmt::format("  {}: {} {:.1f}{} [{:.1f}, {:.1f}] ({} seeds)\n", group.name,
                        success ? "success" : "return", InterquartileMean(values),
                        success ? " %" : "", interval.low, interval.high, values.size());
  }
  if (text.empty()) return "";
  return "\ninterquartile mean over seeds [95 %, stratified bootstrap]:\n" + text;
}

}  // namespace

std::string FormatSeeds(const GroupFigures& group) {
  const std::string seeds = std::to_string(group.figures.returns.size());
  if (group.failed.empty()) return seeds;
  const size_t left_out = group.figures.failed;
  return seeds + (left_out == 0 ? ", failed" : fmt::format(", {} failed", left_out));
}

std::string FormatSteps(const GroupFigures& group) {
  std::vector<std::string> words;
  for (size_t i = 0; i < group.n_to_target.size(); ++i) {
    if (const auto& n = group.n_to_target[i]) {
      words.push_back(fmt::format("{:.0f} ({:.0f} s)", *n, *group.seconds_to_target[i]));
    } else {
      words.emplace_back(group.over[i] ? "not reached" : "not yet");
    }
  }
  return words.empty() ? "-" : fmt::format("{}", fmt::join(words, ", "));
}

std::vector<KeyDifference> FindDifferences(const std::vector<RunGroup>& groups) {
  std::vector<KeyDifference> differences;
  for (const auto& [key, unused] : KeysOf(Config())) {
    if (std::ranges::find(kNamesOfRuns, key) == kNamesOfRuns.end())
      differences.push_back({key, {}});
  }
  for (const RunGroup& group : groups) {
    std::vector<std::pair<std::string, std::string>> keys;
    if (!group.runs.empty()) keys = KeysOf(group.runs[0].config);
    for (KeyDifference& difference : differences) {
      const auto found =
          std::ranges::find(keys, difference.key, [](const auto& k) { return k.first; });
      difference.values.push_back(found == keys.end() ? "-" : found->second);
    }
  }
  std::erase_if(differences, [](const KeyDifference& difference) {
    return std::ranges::all_of(
        difference.values, [&](const std::string& value) { return value == difference.values[0]; });
  });
  return differences;
}

Comparison Compare(const std::vector<RunGroup>& groups, double target_success) {
  CheckOneTask(groups);
  return Gather(groups, target_success);
}

Comparison Gather(const std::vector<RunGroup>& groups, double target_success) {
  Comparison comparison{.target_success = target_success};
  for (const RunGroup& group : groups) {
    if (comparison.task.empty() && !group.runs.empty()) {
      comparison.task = group.runs[0].config.task;
      comparison.baselines = BaselineCache().Find(group.runs[0].config);
    }
    comparison.groups.push_back(FiguresOf(group, target_success));
  }
  for (size_t i = 1; i < comparison.groups.size(); ++i) {
    comparison.ratios.push_back(
        RatioOfEnded(TargetsOf(comparison.groups[i]), TargetsOf(comparison.groups[0])));
  }
  comparison.differences = FindDifferences(groups);
  return comparison;
}

ordered_json ToJson(const Comparison& comparison) {
  ordered_json groups = ordered_json::array(), ratios = ordered_json::array();
  ordered_json differences = ordered_json::array();
  for (const GroupFigures& group : comparison.groups) groups.push_back(GroupJson(group));
  for (size_t i = 0; i < comparison.ratios.size(); ++i) {
    ratios.push_back(RatioJson(comparison.groups[i + 1].name + "/" + comparison.groups[0].name,
                               comparison.ratios[i]));
  }
  for (const KeyDifference& difference : comparison.differences) {
    ordered_json values = ordered_json::array();
    for (const std::string& value : difference.values) {
      values.push_back(value == "-" ? ordered_json(nullptr)
                                    : ParseBoundedJson<ordered_json>(value));
    }
    differences.push_back({{"key", difference.key}, {"values", values}});
  }
  return {{"schema", "shoal-comparison-1"},
          {"task", comparison.task},
          {"target_success", comparison.target_success},
          {"groups", groups},
          {"ratios", ratios},
          {"differences", differences},
          {"baselines", ToJson(comparison.baselines)},
          {"commit", BuildCommit()}};
}

std::string ToText(const Comparison& comparison) {
  std::vector<TableRow> rows{{"", "SEEDS", "SUCCESS [95 %]", "RETURN [95 %]", "DISTANCE, cm [95 %]",
                              "ENV STEPS", "UPDATES", "WALL, s", "CORE-HOURS"}};
  bool has_success = false;
  for (const GroupFigures& group : comparison.groups) {
    has_success |= !group.figures.successes.empty();
    rows.push_back({group.name, FormatSeeds(group), FormatSuccess(group.figures),
                    FormatReturn(group.figures), FormatDistance(group.figures),
                    FormatCounts(group.env_steps), FormatCounts(group.updates),
                    FormatCounts(group.wall_seconds), fmt::format("{:.2f}", group.core_hours)});
  }
  std::string text = comparison.task + "; env steps, updates and wall time are means over seeds\n";
  text += AlignedTable(rows);
  if (has_success) {
    text += fmt::format("\nenv steps (wall clock) to {:.0f} % success, by seed:\n",
                        100 * comparison.target_success);
    for (size_t i = 0; i < comparison.groups.size(); ++i) {
      const GroupFigures& group = comparison.groups[i];
      text += fmt::format("  {}: {}", group.name, FormatSteps(group));
      if (i > 0 && !comparison.ratios[i - 1].pairs.empty()) {
        const std::string& first = comparison.groups[0].name;
        text += fmt::format("; {} times those of {}: {}", FormatMedian(comparison.ratios[i - 1]),
                            first, FormatPairs(comparison.ratios[i - 1], group.name, first));
      }
      text += "\n";
    }
  }
  text += Iqms(comparison);
  if (!comparison.differences.empty()) {
    rows = {{"DIFFERENT KEYS"}};
    for (const GroupFigures& group : comparison.groups) rows[0].push_back(group.name);
    for (const KeyDifference& difference : comparison.differences) {
      rows.push_back({difference.key});
      std::ranges::copy(difference.values, std::back_inserter(rows.back()));
    }
    text += fmt::format("\n{}", AlignedTable(rows));
  }
  if (comparison.baselines) text += fmt::format("\n{}\n", FormatBaselines(*comparison.baselines));
  return text + Notes(comparison);
}

}  // namespace shoal::launch
