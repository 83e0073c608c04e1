// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/web/page_answers.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/config/config_io.h"
#include "launch/run/live_settings.h"
#include "launch/watch/run_figures.h"
#include "launch/watch/top_table.h"

namespace shoal::launch {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

std::string Text(const ordered_json& object) {
  return object.dump(-1, ' ', /*ensure_ascii=*/false, ordered_json::error_handler_t::replace);
}

ordered_json OrNull(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json();
}

ordered_json EvaluationJson(const std::optional<EvaluationPoint>& point) {
  if (!point) return {};
  return {{"env_steps", point->env_steps},
          {"success", OrNull(point->success)},
          {"return", point->mean_return},
          {"text", FormatScore(*point)}};
}

ordered_json ProgressJson(const ProgressFigures& f) {
  return {{"elapsed_seconds", f.elapsed_seconds},
          {"seconds_left", OrNull(f.seconds_left)},
          {"env_steps", f.env_steps},
          {"budget_env_steps", f.budget},
          {"env_steps_per_second", OrNull(f.env_steps_per_second)},
          {"updates", OrNull(f.updates)},
          {"updates_per_second", OrNull(f.updates_per_second)},
          {"rollout_success", OrNull(f.rollout_success)},
          {"rollout_return", OrNull(f.rollout_return)},
          {"rollout_length", OrNull(f.rollout_length)},
          {"last_evaluation", EvaluationJson(f.last_evaluation)},
          {"best", EvaluationJson(f.best)},
          {"restarts", f.restarts},
          {"trouble", f.trouble}};
}

const char* ToString(PlayedEpisode::State state) {
  switch (state) {
    case PlayedEpisode::State::kNone:
      return "none";
    case PlayedEpisode::State::kPlaying:
      return "playing";
    case PlayedEpisode::State::kReady:
      return "ready";
    case PlayedEpisode::State::kFailed:
      return "failed";
  }
  return "?";
}

}  // namespace

std::string ErrorAnswer(std::string_view message) { return Text({{"error", message}}); }

std::string TopAnswer(const RunViewMessage& view) {
  const TopCells cells = MakeTopCells(view);
  ordered_json events = ordered_json::array();
  for (const RunEvent& event : view.events) events.push_back({event.time, event.text});
  const ordered_json rest{{"line", FormatTopLine(view)},
                          {"advice", AdviceOfView(view)},
                          {"columns", cells.columns},
                          {"rows", cells.rows},
                          {"progress", ProgressJson(FiguresOfView(view, Now()))},
                          {"events", events}};
  // The view is exactly the output of `shoal top --json`.
  return "{\"view\":" + TopJson(view) + "," + Text(rest).substr(1);
}

std::string RunsAnswer(const std::filesystem::path& dir, const std::vector<RunListing>& runs) {
  ordered_json keys = ordered_json::array();
  for (const LiveKey& live : LiveKeys()) {
    if (live.key != "actors") keys.push_back(live.key);  // only `scale` changes it
  }
  return "{\"runs\":" + RunListJson(dir, runs) + ",\"keys\":" + Text(keys) + "}";
}

std::string RunAnswer(const std::string& checkpoint, const std::vector<ServedName>& files,
                      const PlayedEpisode& episode) {
  ordered_json list = ordered_json::array();
  for (const ServedName& file : files) {
    list.push_back({{"path", file.path}, {"bytes", file.bytes}, {"modified", file.modified}});
  }
  return Text({{"checkpoint", checkpoint},
               {"files", list},
               {"episode",
                {{"state", ToString(episode.state)},
                 {"film", !episode.film.empty()},
                 {"checkpoint", episode.checkpoint},
                 {"env_steps", episode.env_steps},
                 {"updates", episode.updates},
                 {"seed", episode.seed},
                 {"problem", episode.problem}}}});
}

PageOrder ParsePageOrder(const std::string& body) {
  constexpr std::array<std::string_view, 3> kVerbs = {"set", "scale", "stop"};
  const json object = ParseStrictJson(body, "order");
  const auto verb = object.is_object() ? object.find("verb") : object.end();
  const auto arguments = object.is_object() ? object.find("arguments") : object.end();
  const bool whole = object.is_object() && object.size() == 2 && verb != object.end() &&
                     arguments != object.end() && verb->is_string() && arguments->is_array() &&
                     arguments->size() <= 1 &&
                     std::ranges::all_of(*arguments, [](const json& a) { return a.is_string(); });
  if (!whole || std::ranges::find(kVerbs, verb->get<std::string>()) == kVerbs.end()) {
    throw UsageError(
        "order: expected {{\"verb\": \"set\" | \"scale\" | \"stop\", \"arguments\": [TEXT]}}");
  }
  return {verb->get<std::string>(), arguments->get<std::vector<std::string>>()};
}

}  // namespace shoal::launch
