// SPDX-License-Identifier: Apache-2.0
#include "actor/evaluation/random_baseline.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "actor/evaluation/evaluation.h"
#include "common/base/error.h"
#include "common/base/interrupted.h"
#include "common/tasks/task_registry.h"

namespace shoal::actor {
namespace {

using nlohmann::ordered_json;

// m; the task's own threshold is added.
constexpr double kThresholds[] = {0.01, 0.02, 0.03, 0.05, 0.075, 0.1, 0.15, 0.2, 0.3, 0.5};

ordered_json SuccessByThreshold(const tasks::Task& task,
                                const std::vector<EpisodeResult>& episodes) {
  if (task.goal_size() == 0) return nullptr;
  std::set<double> thresholds(std::begin(kThresholds), std::end(kThresholds));
  thresholds.insert(task.distance_threshold());
  ordered_json curve = ordered_json::array();
  for (const double threshold : thresholds) {
    const auto successes = std::ranges::count_if(episodes, [&](const EpisodeResult& e) {
      return !e.fault && e.figures.final_distance < threshold;
    });
    curve.push_back(
        {{"threshold", threshold},
         {"success_rate", static_cast<double>(successes) / static_cast<double>(episodes.size())}});
  }
  return curve;
}

}  // namespace

ordered_json PlayRandom(const RandomRequest& request, const std::function<bool()>& stop) {
  const tasks::Task& task = tasks::FindTask(request.task);
  const bool noop = request.policy == "noop";
  if (!noop && request.policy != "random") {
    throw UsageError("policy '{}': expected random | noop", request.policy);
  }
  RunConfig run;
  run.config.task = request.task;
  run.config.model = request.model;
  run.config.distance_threshold = request.distance_threshold;
  run.config.action_repeat = request.action_repeat;
  run.config.physics = request.physics;
  run.config.end_on_success = request.end_on_success;
  run.config.observation.pixels = false;
  run.config.observation.proprioception = true;
  run.spec = worlds::MakeEnvironment(run.config, nullptr)->spec();
  Evaluator evaluator(run, noop);  // this policy never receives weights: actions are uniform
  const EpisodeStream stream{request.seed, StreamRole::kFinalEnvironment, 0};
  const std::vector<EpisodeResult> episodes = evaluator.Play(request.episodes, stream, stop);
  if (std::cmp_less(episodes.size(), request.episodes)) {
    throw Interrupted(fmt::format("{} episodes of {}", request.policy, request.task));
  }
  ordered_json result = EvaluationJson(run, {.policy = request.policy}, stream, episodes);
  result["success_by_threshold"] = SuccessByThreshold(task, episodes);
  return result;
}

std::string RandomText(const ordered_json& result) {
  const EvaluationSummary summary = SummaryOf(result, "baseline");
  const EvaluationAggregate& all = summary.aggregate;
  const std::string success =
      all.success_rate ? fmt::format("success {:.1f} %, ", 100 * *all.success_rate) : "";
  std::string text = fmt::format("{}: {} {} episodes, {}return {:.3f} +- {:.3f}, length {:.1f}\n",
                                 summary.task, all.episodes, result.at("policy").get<std::string>(),
                                 success, all.return_mean, all.return_std.value(), all.length_mean);
  text += FaultyEpisodesText(all);
  const ordered_json& curve = result.at("success_by_threshold");
  if (curve.is_null()) return text;
  text += fmt::format("  final distance {:.4f} m; success by threshold:\n",
                      all.final_distance_mean.value());
  for (const ordered_json& point : curve) {
    text += fmt::format("    {:.3f} m {:6.1f} %\n", point.at("threshold").get<double>(),
                        100 * point.at("success_rate").get<double>());
  }
  return text;
}

}  // namespace shoal::actor
