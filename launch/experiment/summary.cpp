#include "launch/experiment/summary.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "common/base/build_info.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;

template <class T>
ordered_json OrNull(const std::optional<T>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json IntervalJson(const std::optional<Interval>& interval) {
  return interval ? ordered_json{interval->low, interval->high} : ordered_json(nullptr);
}

RunOutcome ReadRun(const StoredExperiment& experiment, const ExperimentRun& run,
                   const std::map<std::string, LoggedRun>& log) {
  RunOutcome outcome{.run = run};
  const auto logged = log.find(run.name);
  if (logged != log.end()) outcome.logged = logged->second;
  outcome.report = StandingOf(run.folder, logged == log.end() ? nullptr : &logged->second);
  std::error_code error;
  if (!std::filesystem::exists(run.folder / "config.json", error)) return outcome;
  try {
    outcome.results = ReadRunResults(run.folder);
    outcome.n_to_target =
        StepsToSuccess(outcome.results->curve, experiment.definition.target_success);
  } catch (const Error& e) {
    outcome.report = {RunStanding::kFailed, e.what()};
  }
  return outcome;
}

void Pool(ArmOutcome& arm) {
  for (const RunOutcome& run : arm.runs) {
    if (run.report.standing != RunStanding::kFinished || !run.results->final) continue;
    const EvaluationFigures& final = *run.results->final;
    if (final.success) {
      arm.successes += final.Successes();
      arm.episodes += final.episodes;
    }
    arm.returns.push_back(final.return_mean);
    if (final.final_distance_mean) arm.distances.push_back(*final.final_distance_mean);
  }
}

std::optional<double> AsReal(const std::optional<uint64_t>& value) {
  return value ? std::optional(static_cast<double>(*value)) : std::nullopt;
}

// Pairs of which both runs are finished: one that is still to be done has not failed to reach
// anything.
SampleRatio ArmRatio(const ArmOutcome& arm, const ArmOutcome& first) {
  std::vector<RatioPair> pairs;
  for (size_t i = 0; i < arm.runs.size(); ++i) {
    const RunOutcome &run = arm.runs[i], &reference = first.runs[i];
    const bool done = run.report.standing == RunStanding::kFinished &&
                      reference.report.standing == RunStanding::kFinished;
    if (!done) continue;
    pairs.push_back({run.run.seed, AsReal(run.n_to_target), AsReal(reference.n_to_target)});
  }
  return RatioOf(std::move(pairs));
}

// The words formats.md knows: what is running has not finished.
const char* StatusWord(RunStanding standing) {
  return ToString(standing == RunStanding::kRunning ? RunStanding::kInterrupted : standing);
}

ordered_json TransferJson(const RunResults& results) {
  ordered_json list = ordered_json::array();
  for (const EvaluationFigures& figures : results.transfer) {
    list.push_back({{"task", figures.task},
                    {"success", OrNull(figures.success)},
                    {"episodes", figures.episodes},
                    {"return_mean", figures.return_mean},
                    {"return_std", figures.return_std},
                    {"final_distance_mean", OrNull(figures.final_distance_mean)}});
  }
  return list;
}

ordered_json RunJson(const RunOutcome& outcome, const std::filesystem::path& folder) {
  ordered_json object{{"run", outcome.run.name},
                      {"seed", outcome.run.seed},
                      {"status", StatusWord(outcome.report.standing)},
                      {"path", outcome.run.folder.lexically_relative(folder).string()}};
  const RunResults none{}, &results = outcome.results ? *outcome.results : none;
  const bool begun = outcome.results.has_value();
  const auto if_begun = [&](auto value) { return begun ? ordered_json(value) : nullptr; };
  const auto& final = results.final;
  object["env_steps"] = if_begun(results.env_steps);
  object["updates"] = if_begun(results.updates);
  object["wall_seconds"] = if_begun(results.wall_seconds);
  object["n_to_target"] = OrNull(outcome.n_to_target);
  object["success"] = final ? OrNull(final->success) : nullptr;
  object["episodes"] = final ? ordered_json(final->episodes) : nullptr;
  object["return_mean"] = final ? ordered_json(final->return_mean) : nullptr;
  object["final_distance_mean"] = final ? OrNull(final->final_distance_mean) : nullptr;
  object["beside_others"] = outcome.logged.most_jobs > 1;
  object["cores"] = if_begun(results.cores);
  object["commits"] = results.commits;
  if (!results.transfer.empty()) object["transfer"] = TransferJson(results);
  object["problem"] =
      outcome.report.problem.empty() ? nullptr : ordered_json(outcome.report.problem);
  return object;
}

ordered_json ArmJson(const ArmOutcome& outcome, const Arm& arm,
                     const std::filesystem::path& folder) {
  ordered_json runs = ordered_json::array();
  for (const RunOutcome& run : outcome.runs) runs.push_back(RunJson(run, folder));
  ordered_json object{{"name", arm.name}, {"overrides", arm.set}, {"runs", runs}};
  std::optional<Interval> wilson;
  std::optional<double> pooled, mean, distance;
  if (outcome.episodes > 0) {
    wilson = Wilson95(outcome.successes, outcome.episodes);
    pooled = static_cast<double>(outcome.successes) / static_cast<double>(outcome.episodes);
  }
  if (!outcome.returns.empty()) mean = Mean(outcome.returns);
  if (!outcome.distances.empty()) distance = Mean(outcome.distances);
  object["success"] = {{"pooled", OrNull(pooled)},
                       {"episodes", outcome.episodes},
                       {"wilson95", IntervalJson(wilson)}};
  object["return"] = {{"mean", OrNull(mean)},
                      {"ci95", IntervalJson(MeanInterval95(outcome.returns))},
                      {"seeds", outcome.returns.size()}};
  object["final_distance"] = {{"mean", OrNull(distance)},
                              {"ci95", IntervalJson(MeanInterval95(outcome.distances))},
                              {"seeds", outcome.distances.size()}};
  return object;
}

ordered_json RatioJson(const ExperimentOutcome::NamedRatio& named) {
  ordered_json pairs = ordered_json::array();
  for (const RatioPair& pair : named.ratio.pairs) {
    pairs.push_back({{"seed", pair.seed},
                     {"n", OrNull(pair.n)},
                     {"n_reference", OrNull(pair.reference)},
                     {"ratio", OrNull(pair.Ratio())}});
  }
  return {{"name", named.name},
          {"pairs", pairs},
          {"not_reached", named.ratio.not_reached},
          {"median", OrNull(named.ratio.median)}};
}

// Of the first arm's task; those of other tasks beside it, by name.
ordered_json BaselinesJson(const ExperimentOutcome& outcome) {
  if (outcome.baselines.empty()) return ordered_json::object();
  ordered_json object = ToJson(std::optional(outcome.baselines[0].second));
  for (size_t i = 1; i < outcome.baselines.size(); ++i) {
    const auto& [task, baselines] = outcome.baselines[i];
    object["other_tasks"][task] = ToJson(std::optional(baselines));
  }
  return object;
}

std::string FormatRatio(const ExperimentOutcome::NamedRatio& named) {
  std::vector<std::string> pairs;
  for (const RatioPair& pair : named.ratio.pairs) {
    const auto ratio = pair.Ratio();
    pairs.push_back(ratio ? fmt::format("{:.2f}", *ratio) : "not reached");
  }
  const std::string median =
      named.ratio.median ? fmt::format("{:.2f}", *named.ratio.median) : "unknown";
  return fmt::format("  {}: median {} of {} seed(s), {} not reached: {}\n", named.name, median,
                     pairs.size(), named.ratio.not_reached, fmt::join(pairs, ", "));
}

std::string Missing(const ExperimentOutcome& outcome) {
  std::vector<std::string> missing;
  for (const ArmOutcome& arm : outcome.arms) {
    for (const RunOutcome& run : arm.runs) {
      if (run.report.standing == RunStanding::kFinished) continue;
      missing.push_back(fmt::format("{} ({})", run.run.name, ToString(run.report.standing)));
    }
  }
  return missing.empty() ? "" : fmt::format("not finished: {}\n", fmt::join(missing, ", "));
}

}  // namespace

std::string FormatPooled(uint64_t successes, uint64_t episodes) {
  if (episodes == 0) return "-";
  const Interval interval = Wilson95(successes, episodes);
  return fmt::format("{:.1f} % [{:.1f}, {:.1f}] ({}/{})",
                     100 * static_cast<double>(successes) / static_cast<double>(episodes),
                     100 * interval.low, 100 * interval.high, successes, episodes);
}

std::string FormatMean(const std::vector<double>& values, int digits) {
  if (values.empty()) return "-";
  const auto interval = MeanInterval95(values);
  const std::string mean = fmt::format("{:.{}f}", Mean(values), digits);
  if (!interval) return mean + " (1 seed)";
  return fmt::format("{} [{:.{}f}, {:.{}f}] ({} seeds)", mean, interval->low, digits,
                     interval->high, digits, values.size());
}

std::vector<Config> JudgedConfigs(const StoredExperiment& experiment) {
  std::vector<Config> configs;
  const auto add = [&](Config config) {
    if (std::ranges::count(configs, config.task, &Config::task) == 0) {
      configs.push_back(std::move(config));
    }
  };
  for (const Arm& arm : experiment.definition.arms) {
    add(ArmConfig(experiment.base, arm, experiment.definition.name));
  }
  for (const std::string& task : experiment.definition.transfer) {
    // As `shoal eval --task` plays it: without the run's model file.
    Config config = experiment.base;
    config.task = task;
    config.model.clear();
    add(std::move(config));
  }
  return configs;
}

ExperimentOutcome ReadOutcome(const StoredExperiment& experiment) {
  ExperimentOutcome outcome{.experiment = experiment};
  const auto log = experiment.Log().Read();
  for (const Arm& arm : experiment.definition.arms) outcome.arms.push_back({.name = arm.name});
  for (const ExperimentRun& run : experiment.Runs()) {
    outcome.arms[run.arm].runs.push_back(ReadRun(experiment, run, log));
  }
  const BaselineCache cache;
  for (const Config& config : JudgedConfigs(experiment)) {
    if (auto found = cache.Find(config)) outcome.baselines.emplace_back(config.task, *found);
  }
  bool has_success = false;
  for (ArmOutcome& arm : outcome.arms) {
    Pool(arm);
    has_success |= arm.episodes > 0;
  }
  for (size_t i = 1; has_success && i < outcome.arms.size(); ++i) {
    outcome.ratios.push_back({outcome.arms[i].name + "/" + outcome.arms[0].name,
                              ArmRatio(outcome.arms[i], outcome.arms[0])});
  }
  return outcome;
}

ordered_json ToJson(const ExperimentOutcome& outcome) {
  const StoredExperiment& experiment = outcome.experiment;
  const Definition& definition = experiment.definition;
  ordered_json arms = ordered_json::array(), ratios = ordered_json::array();
  for (size_t i = 0; i < outcome.arms.size(); ++i) {
    arms.push_back(ArmJson(outcome.arms[i], definition.arms[i], experiment.folder));
  }
  for (const auto& named : outcome.ratios) ratios.push_back(RatioJson(named));
  return {{"schema", "shoal-experiment-1"},
          {"name", definition.name},
          {"question", definition.question},
          {"base", definition.base},
          {"target_success", definition.target_success},
          {"commit", BuildCommit()},
          {"created", UtcTimestamp()},
          {"arms", arms},
          {"ratios", ratios},
          {"baselines", BaselinesJson(outcome)}};
}

void WriteSummary(const ExperimentOutcome& outcome) {
  const std::string text =
      ToJson(outcome).dump(2, ' ', /*ensure_ascii=*/false, ordered_json::error_handler_t::replace);
  WriteFileAtomically(outcome.experiment.folder / "summary.json", text + "\n");
}

std::string SummaryText(const ExperimentOutcome& outcome) {
  const Definition& definition = outcome.experiment.definition;
  std::string text = fmt::format("experiment {}: base {}, {} arm(s)\n", definition.name,
                                 definition.base, definition.arms.size());
  if (!definition.question.empty()) text += definition.question + "\n";
  text += fmt::format("{:<16} {:>8}  {:<30} {:<34} {}\n", "ARM", "FINISHED", "SUCCESS [95 %]",
                      "RETURN [95 %]", "DISTANCE, cm [95 %]");
  for (const ArmOutcome& arm : outcome.arms) {
    std::vector<double> centimetres;
    for (const double metres : arm.distances) centimetres.push_back(100 * metres);
    text += fmt::format("{:<16} {:>8}  {:<30} {:<34} {}\n", arm.name,
                        fmt::format("{}/{}", arm.returns.size(), arm.runs.size()),
                        FormatPooled(arm.successes, arm.episodes), FormatMean(arm.returns, 2),
                        FormatMean(centimetres, 2));
  }
  if (!outcome.ratios.empty()) {
    text += fmt::format("env steps to {:.0f} % success, arm / first arm:\n",
                        100 * definition.target_success);
    for (const auto& named : outcome.ratios) text += FormatRatio(named);
  }
  for (const auto& [task, baselines] : outcome.baselines) {
    text += fmt::format("{} {}\n", task, FormatBaselines(baselines));
  }
  return text + Missing(outcome);
}

std::string StatusText(const ExperimentOutcome& outcome) {
  std::string text = fmt::format("{:<24} {:<12} {:>11} {:>9} {:>8}  {}\n", "RUN", "STATUS",
                                 "ENV STEPS", "UPDATES", "WALL, s", "LAST EVALUATION");
  const size_t seeds = outcome.arms.empty() ? 0 : outcome.arms[0].runs.size();
  for (size_t i = 0; i < seeds; ++i) {
    for (const ArmOutcome& arm : outcome.arms) {
      const RunOutcome& run = arm.runs[i];
      const RunResults none{}, &results = run.results ? *run.results : none;
      std::string last = "-";
      if (results.final || !results.curve.empty()) {
        const EvaluationFigures& figures = results.final ? *results.final : results.curve.back();
        last = figures.success
                   ? fmt::format("{:.1f} % of {}, return {:.2f}", 100 * *figures.success,
                                 figures.episodes, figures.return_mean)
                   : fmt::format("return {:.2f} of {}", figures.return_mean, figures.episodes);
        if (results.final) last += " (final)";
      }
      text += fmt::format("{:<24} {:<12} {:>11} {:>9} {:>8.0f}  {}\n", run.run.name,
                          ToString(run.report.standing), results.env_steps, results.updates,
                          results.wall_seconds, last);
      if (!run.report.problem.empty()) text += "  " + run.report.problem + "\n";
    }
  }
  return text;
}

}  // namespace shoal::launch
