// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/run_figures.h"

#include <fmt/core.h>

#include <string_view>
#include <utility>

#include "common/base/saturating_cast.h"
#include "common/wire/metric_names.h"
#include "common/wire/process_name.h"
#include "launch/watch/advice.h"
#include "learner/agent/algorithms.h"

namespace shoal::launch {

ProgressFigures CollectFigures(const MetricsView& view, SteadyTime now) {
  ProgressFigures figures;
  figures.env_steps_per_second = view.Sum("actor", "env_steps_per_second", now);
  figures.updates = view.Largest("learner", "updates");
  figures.updates_per_second = view.Sum("learner", "updates_per_second", now);
  for (const learner::Figure* figure : learner::AllFigures()) {
    const auto value = view.Average("learner", figure->name);
    if (figure->headline && value) figures.update_figures.emplace_back(figure->name, *value);
  }
  figures.policy_lag = view.Largest("replay", "policy_lag_p50");
  if (!figures.policy_lag) figures.policy_lag = view.Largest("learner", "rollout_lag");
  figures.data_age = view.Largest("learner", "data_age_updates_p50");
  figures.rollout_success = view.Mean("actor", "rollout_success", "episodes", now);
  figures.rollout_return = view.Mean("actor", "rollout_return", "episodes", now);
  figures.rollout_length = view.Mean("actor", "rollout_length", "episodes", now);
  return figures;
}

void AddLately(const RecentRun& recent, const Bottleneck& lately, ProgressFigures* figures) {
  if (const auto rate = recent.env_steps_per_second()) figures->env_steps_per_second = rate;
  if (const auto rate = recent.updates_per_second()) figures->updates_per_second = rate;
  figures->seconds_left = recent.SecondsLeft(static_cast<double>(figures->env_steps),
                                             static_cast<double>(figures->budget));
  if (!lately.limited) return;
  figures->actors_wait = lately.inserts_blocked;
  figures->learner_waits = lately.samples_blocked;
}

namespace {

void AddEvaluation(const std::string& prefix, const std::optional<EvaluationPoint>& point,
                   MetricsReport* report) {
  if (!point) return;
  if (point->success) report->Add(prefix + "_success", *point->success);
  report->Add(prefix + "_return", point->mean_return);
  if (point->return_std) report->Add(prefix + "_return_std", *point->return_std);
  report->Add(prefix + "_length", point->mean_length);
  report->Add(prefix + "_episodes", static_cast<double>(point->episodes));
  report->Add(prefix + "_env_steps", static_cast<double>(point->env_steps));
}

std::optional<EvaluationPoint> FindEvaluation(const MetricsView& view, const std::string& prefix) {
  const auto get = [&](const char* name) {
    return view.Get(ProcessName::Coordinator(), prefix + name);
  };
  if (!get("_return")) return std::nullopt;
  EvaluationPoint point;
  point.success = get("_success");
  point.mean_return = *get("_return");
  point.return_std = get("_return_std");
  point.mean_length = get("_length").value_or(0);
  point.episodes = SaturatingCast<size_t>(get("_episodes").value_or(0));
  point.env_steps = SaturatingCast<uint64_t>(get("_env_steps").value_or(0));
  return point;
}

}  // namespace

void AddRunFigures(const ProgressFigures& figures, MetricsReport* report) {
  const auto add = [&](const char* name, const auto& value) {
    if (value) report->Add(name, *value);
  };
  report->Add("elapsed_seconds", figures.elapsed_seconds);
  report->Add("env_steps", static_cast<double>(figures.env_steps));
  add("env_steps_per_second", figures.env_steps_per_second);
  add("updates_per_second", figures.updates_per_second);
  add("seconds_left", figures.seconds_left);
  add("rollout_success", figures.rollout_success);
  add("rollout_return", figures.rollout_return);
  add("limiter_blocked_insert_share", figures.actors_wait);
  add("limiter_blocked_sample_share", figures.learner_waits);
  AddEvaluation("last_evaluation", figures.last_evaluation, report);
  AddEvaluation("best_evaluation", figures.best, report);
  report->Add("processes", figures.processes);
  report->Add("restarts", figures.restarts);
  report->Add("actors_working", figures.actors_working);
  report->Add("faulty_episodes", static_cast<double>(figures.faulty_episodes));
  report->AddResources();
}

void AddOrders(const Config& config, const RunResources& resources, MetricsReport* report) {
  report->Add("actors", resources.actors);
  report->Add("actors_elsewhere", resources.actors_elsewhere ? 1 : 0);
  report->Add("budget_env_steps", static_cast<double>(config.env_steps));
  report->Add("stop_success", config.stop.success);
  report->Add("stop_evaluations", config.stop.evaluations);
  report->Add("usable_cores", resources.usable_cores);
  report->Add("learner_threads", resources.learner_threads);
  report->Add("most_threads", resources.most_threads);
  report->Add("may_play_ahead", resources.may_play_ahead ? 1 : 0);
}

namespace {

constexpr std::string_view kRecent = "recent";
constexpr double kLookedAt = 30;  // seconds over which shares are computed

}  // namespace

void AddShares(const Bottleneck& lately, MetricsMessage* report) {
  const auto add = [&](std::string name, double value) {
    report->names.push_back(std::move(name));
    report->values.push_back(value);
  };
  for (const ProcessTimes& times : lately.roles) {
    for (const StageShare& share : times.stages) {
      if (share.stage == kOtherStage) continue;
      add(fmt::format("{}_{}_{}", kRecent, times.role, share.stage), share.share);
    }
  }
  if (!lately.roles.empty()) add("recent_cores", lately.cores);
}

std::string AdviceOfView(const RunViewMessage& message) {
  if (message.state == "evaluating") return "Training is over; its final evaluation is played.";
  if (message.state == "ended") return "The run has ended.";
  if (message.state != "running") return "The run is ending: its processes store what they have.";
  MetricsView view;
  for (const MetricsMessage& process : message.processes) view.OnMessage(process, Now());
  const auto own = [&](const std::string& name) {
    return view.Get(ProcessName::Coordinator(), name);
  };
  Bottleneck lately{.seconds = std::min(kLookedAt, own("elapsed_seconds").value_or(0)),
                    .cores = own("recent_cores").value_or(0),
                    .usable = own("usable_cores").value_or(0)};
  lately.limited = own("limiter_blocked_insert_share").has_value();
  lately.inserts_blocked = own("limiter_blocked_insert_share").value_or(0);
  lately.samples_blocked = own("limiter_blocked_sample_share").value_or(0);
  for (const Metric& metric : ProcessMetrics()) {
    if (metric.kind != MetricKind::kStage) continue;
    const auto share = own(fmt::format("{}_{}_{}", kRecent, metric.role, metric.name));
    if (!share) continue;
    if (lately.roles.empty() || lately.roles.back().role != metric.role) {
      lately.roles.push_back({.role = std::string(metric.role)});
    }
    lately.roles.back().stages.push_back({std::string(metric.name), *share});
  }
  const std::string advice =
      Advise(lately, {.usable_cores = lately.usable,
                      .actors = SaturatingCast<int>(own("actors").value_or(0)),
                      .actors_elsewhere = own("actors_elsewhere").value_or(0) > 0,
                      .learner_threads = SaturatingCast<int>(own("learner_threads").value_or(0)),
                      .most_threads = SaturatingCast<int>(own("most_threads").value_or(0)),
                      .may_play_ahead = own("may_play_ahead").value_or(0) > 0});
  return advice.empty() ? "Too early to say where the time goes." : advice;
}

ProgressFigures FiguresOfView(const RunViewMessage& message, SteadyTime now) {
  MetricsView view;
  for (const MetricsMessage& process : message.processes) view.OnMessage(process, now);
  const auto own = [&](const char* name) { return view.Get(ProcessName::Coordinator(), name); };
  ProgressFigures figures = CollectFigures(view, now);
  figures.run = message.run;
  figures.state = message.state;
  figures.elapsed_seconds = own("elapsed_seconds").value_or(0);
  figures.env_steps = message.env_steps;
  figures.budget = SaturatingCast<uint64_t>(own("budget_env_steps").value_or(0));
  figures.last_evaluation = FindEvaluation(view, "last_evaluation");
  figures.best = FindEvaluation(view, "best_evaluation");
  figures.processes = SaturatingCast<int>(own("processes").value_or(0));
  figures.restarts = SaturatingCast<int>(own("restarts").value_or(0));
  figures.actors_working = SaturatingCast<int>(own("actors_working").value_or(0));
  figures.faulty_episodes = SaturatingCast<uint64_t>(own("faulty_episodes").value_or(0));
  figures.env_steps_per_second = figures.updates_per_second = std::nullopt;
  // Once no process is left, the same view is repeated: it has no current rates.
  if (message.state == "evaluating" || message.state == "ended") return figures;
  figures.trouble = message.trouble;
  figures.env_steps_per_second = own("env_steps_per_second");
  figures.updates_per_second = own("updates_per_second");
  figures.seconds_left = own("seconds_left");
  figures.rollout_success = own("rollout_success");
  figures.rollout_return = own("rollout_return");
  figures.actors_wait = own("limiter_blocked_insert_share");
  figures.learner_waits = own("limiter_blocked_sample_share");
  return figures;
}

}  // namespace shoal::launch
