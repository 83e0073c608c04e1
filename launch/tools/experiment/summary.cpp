// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/summary.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "common/base/build_info.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/or_null.h"
#include "launch/record/run_folder.h"
#include "launch/tools/experiment/arm_table.h"
#include "launch/tools/experiment/frames_table.h"
#include "launch/tools/experiment/statistics_json.h"

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;

RunOutcome ReadRun(const StoredExperiment& experiment, const ExperimentRun& run,
                   const std::map<std::string, LoggedRun>& log) {
  RunOutcome outcome{.run = run};
  const auto logged = log.find(run.name);
  if (logged != log.end()) outcome.logged = logged->second;
  outcome.report = experiment.Standing(run, log);
  if (!IsRun(run.folder)) return outcome;
  try {
    outcome.results = ReadRunResults(run.folder);
    outcome.n_to_target = StepsToSuccess(*outcome.results, experiment.definition.target_success);
    if (outcome.report.standing != ExperimentRunStatus::kFailed) {
      outcome.at_frames = ReturnsAtFrames(*outcome.results, experiment.definition.frames);
    }
  } catch (const Error& e) {
    outcome.report = {ExperimentRunStatus::kFailed, e.what()};
  }
  return outcome;
}

void Gather(ArmOutcome& arm) {
  for (const RunOutcome& run : arm.runs) {
    const ExperimentRunStatus standing = run.report.standing;
    if (standing == ExperimentRunStatus::kFailed) ++arm.figures.failed;
    if (standing != ExperimentRunStatus::kFinished || !run.results->final) continue;
    const EvaluationFigures& final = *run.results->final;
    arm.figures.Add(final.success, final.episodes, final.return_mean, final.final_distance_mean);
  }
}

FramesArm FramesArmOf(const ArmOutcome& arm, std::string task) {
  FramesArm frames{.name = arm.name, .task = std::move(task)};
  for (const RunOutcome& run : arm.runs) {
    const bool failed = run.report.standing == ExperimentRunStatus::kFailed;
    frames.runs.push_back({.seed = run.run.seed, .failed = failed, .returns = run.at_frames});
  }
  return frames;
}

void GatherFrames(ExperimentOutcome& outcome) {
  const StoredExperiment& experiment = outcome.experiment;
  const Definition& definition = experiment.definition;
  outcome.frames.frames = definition.frames;
  if (definition.frames.empty()) return;
  for (size_t i = 0; i < outcome.arms.size(); ++i) {
    const Config config = ArmConfig(experiment.base, definition.arms[i], definition.name);
    outcome.frames.arms.push_back(FramesArmOf(outcome.arms[i], config.task));
  }
  if (definition.reference.empty()) return;
  try {
    SetReference(ReadReference(FindReference(definition.reference)), &outcome.frames);
  } catch (const Error& e) {
    // The results of the runs do not depend on the reference, so they are shown without it.
    outcome.reference_problem = e.what();
  }
}

std::vector<TargetReached> TargetsOf(const ArmOutcome& arm) {
  std::vector<TargetReached> targets;
  for (const RunOutcome& run : arm.runs) {
    const ExperimentRunStatus standing = run.report.standing;
    const bool over =
        standing == ExperimentRunStatus::kFinished || standing == ExperimentRunStatus::kFailed;
    const auto n = run.n_to_target;
    targets.push_back(
        {run.run.seed, over, n ? std::optional(static_cast<double>(*n)) : std::nullopt});
  }
  return targets;
}

// Uses the words of docs/experiments.md, in which an active run is "interrupted".
const char* StatusWord(ExperimentRunStatus standing) {
  return ToString(standing == ExperimentRunStatus::kRunning ? ExperimentRunStatus::kInterrupted
                                                            : standing);
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

ordered_json RunJson(const RunOutcome& outcome, const std::filesystem::path& folder,
                     bool with_frames) {
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
  object["cpu_seconds"] = OrNull(results.cpu_seconds);
  object["energy_wh"] = OrNull(results.energy_wh);
  object["n_to_target"] = OrNull(outcome.n_to_target);
  object["success"] = final ? OrNull(final->success) : nullptr;
  object["episodes"] = final ? ordered_json(final->episodes) : nullptr;
  object["return_mean"] = final ? ordered_json(final->return_mean) : nullptr;
  object["final_distance_mean"] = final ? OrNull(final->final_distance_mean) : nullptr;
  object["beside_others"] = outcome.logged.most_jobs > 1;
  object["cores"] = if_begun(results.cores);
  object["commits"] = results.commits;
  if (!results.transfer.empty()) object["transfer"] = TransferJson(results);
  if (with_frames) object["at_frames"] = AtFramesJson(outcome.at_frames);
  object["problem"] =
      outcome.report.problem.empty() ? nullptr : ordered_json(outcome.report.problem);
  return object;
}

ordered_json ArmJson(const ExperimentOutcome& experiment, size_t i) {
  const ArmOutcome& outcome = experiment.arms[i];
  const bool with_frames = !experiment.frames.frames.empty();
  ordered_json runs = ordered_json::array();
  for (const RunOutcome& run : outcome.runs) {
    runs.push_back(RunJson(run, experiment.experiment.folder, with_frames));
  }
  ordered_json object{{"name", outcome.name},
                      {"overrides", experiment.experiment.definition.arms[i].set},
                      {"runs", runs}};
  SetAggregates(outcome.figures, &object);
  if (with_frames) object["task"] = experiment.frames.arms[i].task;
  return object;
}

void AddFrames(const FramesResults& results, ordered_json* summary) {
  if (results.frames.empty()) return;
  (*summary)["frames"] = results.frames;
  if (!results.reference.empty()) (*summary)["reference"] = ReferenceJson(results);
  SetFramesAggregates(results, summary);
}

// Baselines of the first arm's world, and of further tasks and arms with another world.
ordered_json BaselinesJson(const ExperimentOutcome& outcome) {
  ordered_json object = ordered_json::object();
  for (const auto& [world, baselines] : outcome.baselines) {
    const ordered_json figures = ToJson(std::optional(baselines));
    switch (world.kind) {
      case JudgedWorld::Kind::kFirst:
        object.update(figures);
        break;
      case JudgedWorld::Kind::kOtherTask:
        object["other_tasks"][world.name] = figures;
        break;
      case JudgedWorld::Kind::kOtherArm:
        object["other_arms"][world.name] = figures;
        break;
    }
  }
  return object;
}

std::string Missing(const ExperimentOutcome& outcome) {
  std::vector<std::string> missing;
  for (const ArmOutcome& arm : outcome.arms) {
    for (const RunOutcome& run : arm.runs) {
      if (run.report.standing == ExperimentRunStatus::kFinished) continue;
      missing.push_back(fmt::format("{} ({})", run.run.name, ToString(run.report.standing)));
    }
  }
  return missing.empty() ? "" : fmt::format("not finished: {}\n", fmt::join(missing, ", "));
}

}  // namespace

std::vector<JudgedWorld> JudgedWorlds(const StoredExperiment& experiment) {
  using Kind = JudgedWorld::Kind;
  std::vector<JudgedWorld> worlds;
  const auto add = [&](Config config, const std::string& arm) {
    bool same = false, same_task = false;
    for (const JudgedWorld& other : worlds) {
      same |= ShareBaselines(config, other.config);
      same_task |= config.task == other.config.task;
    }
    if (same || (same_task && arm.empty())) return;
    const Kind kind = worlds.empty() ? Kind::kFirst
                      : same_task    ? Kind::kOtherArm
                                     : Kind::kOtherTask;
    const std::string name = kind == Kind::kOtherArm ? arm : config.task;
    worlds.push_back({kind, name, std::move(config)});
  };
  for (const Arm& arm : experiment.definition.arms) {
    add(ArmConfig(experiment.base, arm, experiment.definition.name), arm.name);
  }
  for (const std::string& task : experiment.definition.transfer) {
    // Like `shoal eval --task`, ignores the run's model file.
    Config config = experiment.base;
    config.task = task;
    config.model.clear();
    add(std::move(config), "");
  }
  return worlds;
}

ExperimentOutcome ReadOutcome(const StoredExperiment& experiment) {
  ExperimentOutcome outcome{.experiment = experiment};
  const auto log = experiment.Log().Read();
  for (const Arm& arm : experiment.definition.arms) outcome.arms.push_back({.name = arm.name});
  for (const ExperimentRun& run : experiment.Runs()) {
    outcome.arms[run.arm].runs.push_back(ReadRun(experiment, run, log));
  }
  const BaselineCache cache;
  for (JudgedWorld& world : JudgedWorlds(experiment)) {
    const auto found = cache.Find(world.config);
    if (found) outcome.baselines.push_back({std::move(world), *found});
  }
  GatherFrames(outcome);
  bool has_success = false;
  for (ArmOutcome& arm : outcome.arms) {
    Gather(arm);
    has_success |= !arm.figures.successes.empty();
  }
  for (size_t i = 1; has_success && i < outcome.arms.size(); ++i) {
    outcome.ratios.push_back(
        {outcome.arms[i].name, outcome.arms[0].name,
         RatioOfEnded(TargetsOf(outcome.arms[i]), TargetsOf(outcome.arms[0]))});
  }
  return outcome;
}

ordered_json ToJson(const ExperimentOutcome& outcome) {
  const Definition& definition = outcome.experiment.definition;
  ordered_json arms = ordered_json::array(), ratios = ordered_json::array();
  for (size_t i = 0; i < outcome.arms.size(); ++i) {
    arms.push_back(ArmJson(outcome, i));
  }
  for (const auto& named : outcome.ratios) {
    ratios.push_back(RatioJson(named.arm + "/" + named.first, named.ratio));
  }
  ordered_json summary{{"schema", kSummarySchema},
                       {"name", definition.name},
                       {"question", definition.question},
                       {"base", definition.base},
                       {"target_success", definition.target_success},
                       {"n_to_target_rule", kReachedTogether},
                       {"commit", BuildCommit()},
                       {"created", UtcTimestamp()},
                       {"arms", arms},
                       {"ratios", ratios},
                       {"baselines", BaselinesJson(outcome)}};
  AddFrames(outcome.frames, &summary);
  return summary;
}

void WriteSummary(const ExperimentOutcome& outcome) {
  const std::string text =
      ToJson(outcome).dump(2, ' ', /*ensure_ascii=*/false, ordered_json::error_handler_t::replace);
  WriteFileForOthers(outcome.experiment.folder / "summary.json", text + "\n");
}

std::string SummaryText(const ExperimentOutcome& outcome) {
  const Definition& definition = outcome.experiment.definition;
  std::string text = fmt::format("experiment {}: base {}, {} arm(s)\n", definition.name,
                                 definition.base, definition.arms.size());
  if (!definition.question.empty()) text += definition.question + "\n";
  std::vector<ArmRow> rows;
  for (const ArmOutcome& arm : outcome.arms) {
    rows.push_back({arm.name, arm.figures, arm.runs.size()});
  }
  text += ArmTable(rows) + FramesText(outcome.frames);
  if (!outcome.reference_problem.empty()) {
    text += fmt::format("the reference is not shown: {}\n", outcome.reference_problem);
  }
  if (!outcome.ratios.empty()) {
    text += fmt::format("env steps to {:.0f} % success, arm / first arm:\n",
                        100 * definition.target_success);
    for (const auto& [arm, first, ratio] : outcome.ratios) {
      text += fmt::format("  {} / {}: {}", arm, first, FormatMedian(ratio));
      if (!ratio.pairs.empty()) text += fmt::format(" ({})", FormatPairs(ratio, arm, first));
      text += "\n";
    }
  }
  for (const auto& [world, baselines] : outcome.baselines) {
    const bool of_arm = world.kind == JudgedWorld::Kind::kOtherArm;
    text += fmt::format("{}{} {}\n", world.config.task, of_arm ? " of arm " + world.name : "",
                        FormatBaselines(baselines));
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
