// SPDX-License-Identifier: Apache-2.0
#include "common/run_folder/evaluation_file.h"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/run_folder/json_members.h"
#include "common/run_folder/run_file_names.h"

namespace shoal {
namespace {

using nlohmann::ordered_json;

constexpr char kWallSeconds[] = "wall_seconds";

template <class T>
ordered_json ValueOrNull(const std::optional<T>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json FiniteOrNull(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json(nullptr);
}

ordered_json EpisodeObject(const EvaluatedEpisode& episode) {
  ordered_json object{{"seed", episode.seed},
                      {"success", ValueOrNull(episode.success)},
                      {"return", episode.episode_return},
                      {"length", episode.length},
                      {"final_distance", FiniteOrNull(episode.final_distance)},
                      {"action_smoothness", episode.action_smoothness}};
  if (episode.goal) {
    const auto& [desired, achieved, failure] = *episode.goal;
    object["desired_goal"] = desired;
    object["achieved_goal"] = achieved;
    object["failure"] = failure.empty() ? ordered_json(nullptr) : ordered_json(failure);
  }
  if (!episode.fault.empty()) object["fault"] = episode.fault;
  for (const auto& [body, mass_kg] : episode.body_mass_kg) object["body_mass"][body] = mass_kg;
  return object;
}

ordered_json AggregateObject(const EvaluationAggregate& aggregate) {
  ordered_json object{{"episodes", aggregate.episodes},
                      {"success_rate", ValueOrNull(aggregate.success_rate)},
                      {"return_mean", aggregate.return_mean},
                      {"return_std", ValueOrNull(aggregate.return_std)},
                      {"length_mean", aggregate.length_mean},
                      {"final_distance_mean", ValueOrNull(aggregate.final_distance_mean)}};
  if (aggregate.faulty_episodes > 0) object["faulty_episodes"] = aggregate.faulty_episodes;
  return object;
}

ordered_json VersionObject(const std::optional<EvaluationSummary::Version>& version) {
  if (!version) return nullptr;
  return {{"session", version->session}, {"update", version->update}};
}

}  // namespace

ordered_json ToJson(const EvaluationFile& file) {
  const EvaluationSummary& summary = file.summary;
  ordered_json episodes = ordered_json::array();
  for (const EvaluatedEpisode& episode : file.episodes) episodes.push_back(EpisodeObject(episode));
  ordered_json object{{"schema", kEvaluationSchema},
                      {"task", summary.task},
                      {"policy", file.policy},
                      {"checkpoint", ValueOrNull(summary.checkpoint)},
                      {"weights_version", VersionObject(summary.version)},
                      {"env_steps", summary.env_steps},
                      {"deterministic", file.deterministic},
                      {"cameras", file.cameras},
                      {"seeds", {file.seed}},
                      {"stream", {{"role", file.stream_role}, {"group", file.stream_group}}},
                      {"episodes", episodes},
                      {"aggregate", AggregateObject(summary.aggregate)},
                      {"commit", file.commit},
                      {"created", file.created}};
  // Goals that must be reached once differ from goals that must be held until the end.
  if (file.end_on_success) object["end_on_success"] = true;
  if (file.failures) {
    ordered_json& failures = object["failures"] = ordered_json::object();
    for (const auto& [cause, count] : *file.failures) failures[cause] = count;
  }
  if (file.episodes_asked) object["episodes_asked"] = *file.episodes_asked;
  if (file.trained_task) object["trained_task"] = *file.trained_task;
  if (summary.wall_seconds > 0) SetWallSeconds(summary.wall_seconds, &object);
  return object;
}

ordered_json ParseEvaluationObject(const std::string& text, const std::string& source) {
  return ParseSchemaObject(text, source, kEvaluationSchema);
}

EvaluationSummary SummaryOf(const ordered_json& evaluation, const std::string& source) {
  const JsonMembers members(evaluation, source);
  const JsonMembers aggregate = members.Object("aggregate");
  EvaluationSummary summary;
  summary.task = members.TextIfAny("task").value_or("");
  summary.checkpoint = members.TextIfAny("checkpoint");
  if (members.Has("weights_version")) {
    const JsonMembers version = members.Object("weights_version");
    summary.version = {.session = version.Count("session"), .update = version.Count("update")};
  }
  summary.env_steps = members.Count("env_steps");
  summary.wall_seconds = members.NumberIfAny(kWallSeconds).value_or(0);
  aggregate.At("success_rate");  // null for a task without success, but always present
  summary.aggregate = {.episodes = members.List("episodes").size(),
                       .success_rate = aggregate.NumberIfAny("success_rate"),
                       .return_mean = aggregate.Number("return_mean"),
                       .return_std = aggregate.NumberIfAny("return_std"),
                       .length_mean = aggregate.Number("length_mean"),
                       .final_distance_mean = aggregate.NumberIfAny("final_distance_mean")};
  if (aggregate.Has("faulty_episodes")) {
    summary.aggregate.faulty_episodes = aggregate.Count("faulty_episodes");
  }
  return summary;
}

std::string FaultyEpisodesText(const EvaluationAggregate& aggregate) {
  if (aggregate.faulty_episodes == 0) return "";
  return fmt::format(
      "  {} of {} episodes ended at a number that is not finite and count as failed\n",
      aggregate.faulty_episodes, aggregate.episodes);
}

void SetWallSeconds(double wall_seconds, ordered_json* evaluation) {
  (*evaluation)[kWallSeconds] = wall_seconds;
}

}  // namespace shoal
