#include "launch/watch/run_figures.h"

#include "common/base/saturating_cast.h"
#include "learner/agent/algorithms.h"

namespace shoal::launch {

ProgressFigures CollectFigures(const MetricsView& view, SteadyTime now) {
  ProgressFigures figures;
  figures.env_steps_per_second = view.Sum("actor", "env_steps_per_second", now);
  figures.updates = view.Get("learner", 0, "updates");
  figures.updates_per_second = view.Sum("learner", "updates_per_second", now);
  for (const learner::Figure* figure : learner::AllFigures()) {
    const auto value = view.Get("learner", 0, std::string(figure->name));
    if (figure->headline && value) figures.update_figures.emplace_back(figure->name, *value);
  }
  figures.policy_lag = view.Get("replay", 0, "policy_lag_p50");
  if (!figures.policy_lag) figures.policy_lag = view.Get("learner", 0, "rollout_lag");
  figures.data_age = view.Get("learner", 0, "data_age_updates_p50");
  figures.rollout_success = view.Mean("actor", "rollout_success", "episodes", now);
  // Seconds blocked per second: a share.
  figures.actors_wait = view.Rate("replay", "limiter_blocked_insert_seconds");
  figures.learner_waits = view.Rate("replay", "limiter_blocked_sample_seconds");
  return figures;
}

namespace {

void AddEvaluation(const std::string& prefix, const std::optional<EvaluationPoint>& point,
                   MetricsReport* report) {
  if (!point) return;
  if (point->success) report->Add(prefix + "_success", *point->success);
  report->Add(prefix + "_return", point->mean_return);
  report->Add(prefix + "_env_steps", static_cast<double>(point->env_steps));
}

std::optional<EvaluationPoint> FindEvaluation(const MetricsView& view, const std::string& prefix) {
  const auto get = [&](const char* name) { return view.Get("coordinator", 0, prefix + name); };
  if (!get("_return")) return std::nullopt;
  EvaluationPoint point;
  point.success = get("_success");
  point.mean_return = *get("_return");
  point.env_steps = SaturatingCast<uint64_t>(get("_env_steps").value_or(0));
  return point;
}

}  // namespace

void AddRunFigures(const ProgressFigures& figures, MetricsReport* report) {
  const auto add = [&](const char* name, const auto& value) {
    if (value) report->Add(name, *value);
  };
  report->Add("elapsed_seconds", figures.elapsed_seconds);
  add("env_steps_per_second", figures.env_steps_per_second);
  add("updates_per_second", figures.updates_per_second);
  add("rollout_success", figures.rollout_success);
  add("limiter_blocked_insert_share", figures.actors_wait);
  add("limiter_blocked_sample_share", figures.learner_waits);
  AddEvaluation("last_evaluation", figures.last_evaluation, report);
  AddEvaluation("best_evaluation", figures.best, report);
  report->Add("processes", figures.processes);
  report->Add("restarts", figures.restarts);
  report->AddResources();
}

void AddOrders(const Config& config, int usable_cores, MetricsReport* report) {
  report->Add("actors", config.actors);
  report->Add("budget_env_steps", static_cast<double>(config.env_steps));
  report->Add("stop_success", config.stop.success);
  report->Add("stop_evaluations", config.stop.evaluations);
  report->Add("usable_cores", usable_cores);
}

ProgressFigures FiguresOfView(const RunViewMessage& message, SteadyTime now) {
  MetricsView view;
  for (const MetricsMessage& process : message.processes) view.OnMessage(process, now);
  const auto own = [&](const char* name) { return view.Get("coordinator", 0, name); };
  ProgressFigures figures = CollectFigures(view, now);
  figures.run = message.run;
  figures.state = message.state;
  figures.elapsed_seconds = own("elapsed_seconds").value_or(0);
  figures.env_steps = message.env_steps;
  figures.budget = SaturatingCast<uint64_t>(own("budget_env_steps").value_or(0));
  figures.env_steps_per_second = own("env_steps_per_second");
  figures.updates_per_second = own("updates_per_second");
  figures.rollout_success = own("rollout_success");
  figures.actors_wait = own("limiter_blocked_insert_share");
  figures.learner_waits = own("limiter_blocked_sample_share");
  figures.last_evaluation = FindEvaluation(view, "last_evaluation");
  figures.best = FindEvaluation(view, "best_evaluation");
  figures.processes = SaturatingCast<int>(own("processes").value_or(0));
  figures.restarts = SaturatingCast<int>(own("restarts").value_or(0));
  return figures;
}

}  // namespace shoal::launch
