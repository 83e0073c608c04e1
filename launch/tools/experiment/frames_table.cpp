// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/frames_table.h"

#include <fmt/core.h>

#include <algorithm>

#include "launch/tools/experiment/experiment_run_status.h"

namespace shoal::launch {
namespace {

using nlohmann::ordered_json;

constexpr char kAtFrames[] = "at_frames";

std::string MeanLabel(const FramesResults& results) {
  return fmt::format("mean of {} tasks", results.arms.size());
}

// [{frames, return}] of the figures at each of the frames.
template <class FiguresOf>
ordered_json FiguresJson(const std::vector<int64_t>& frames, const FiguresOf& figures_of) {
  ordered_json list = ordered_json::array();
  for (const int64_t one : frames) {
    list.push_back({{"frames", one}, {"return", ReturnJson(figures_of(one))}});
  }
  return list;
}

FramesRun ReadFramesRun(const ordered_json& row) {
  FramesRun run{.seed = row.at("seed").get<int64_t>()};
  run.failed = row.at("status").get<std::string>() == ToString(ExperimentRunStatus::kFailed);
  for (const ordered_json& entry : row.at(kAtFrames)) {
    run.returns.push_back({.frames = entry.at("frames").get<int64_t>(),
                           .env_steps = entry.at("env_steps").get<uint64_t>(),
                           .episodes = entry.at("episodes").get<size_t>(),
                           .return_mean = entry.at("return_mean").get<double>()});
  }
  return run;
}

FramesArm ReadFramesArm(const ordered_json& object) {
  FramesArm arm{.name = object.at("name").get<std::string>(),
                .task = object.at("task").get<std::string>()};
  for (const ordered_json& row : object.at("runs")) arm.runs.push_back(ReadFramesRun(row));
  return arm;
}

void ReadPublished(const ordered_json& reference, FramesResults* results) {
  reference.at("name").get_to(results->reference);
  reference.at("source").get_to(results->source);
  for (const ordered_json& entry : reference.at(kAtFrames)) {
    results->published.push_back({.method = entry.at("method").get<std::string>(),
                                  .task = entry.at("task").get<std::string>(),
                                  .frames = entry.at("frames").get<int64_t>(),
                                  .value = entry.at("return").get<double>()});
  }
}

// Tasks of the arms in their order, each once.
std::vector<std::string> TasksOf(const FramesResults& results) {
  std::vector<std::string> tasks;
  for (const FramesArm& arm : results.arms) {
    if (std::ranges::count(tasks, arm.task) == 0) tasks.push_back(arm.task);
  }
  return tasks;
}

}  // namespace

ordered_json AtFramesJson(const std::vector<ReturnAtFrames>& returns) {
  ordered_json list = ordered_json::array();
  for (const ReturnAtFrames& one : returns) {
    list.push_back({{"frames", one.frames},
                    {"env_steps", one.env_steps},
                    {"episodes", one.episodes},
                    {"return_mean", one.return_mean}});
  }
  return list;
}

ordered_json ReferenceJson(const FramesResults& results) {
  ordered_json list = ordered_json::array();
  for (const PublishedReturn& one : results.published) {
    list.push_back({{"method", one.method},
                    {"task", one.task},
                    {"frames", one.frames},
                    {"return", one.value}});
  }
  return {{"name", results.reference}, {"source", results.source}, {kAtFrames, list}};
}

void SetFramesAggregates(const FramesResults& results, ordered_json* summary) {
  ordered_json& arms = summary->at("arms");
  for (size_t i = 0; i < results.arms.size(); ++i) {
    arms.at(i)[kAtFrames] = FiguresJson(
        results.frames, [&](int64_t frames) { return FiguresAt(results.arms[i], frames); });
  }
  if (!AreDifferentTasks(results.arms)) return;
  (*summary)["mean_of_tasks"] = {{"tasks", results.arms.size()},
                                 {kAtFrames, FiguresJson(results.frames, [&](int64_t frames) {
                                    return MeanOfTasksAt(results.arms, frames);
                                  })}};
}

FramesResults ReadFramesResults(const ordered_json& summary) {
  FramesResults results;
  const auto frames = summary.find("frames");
  if (frames == summary.end()) return results;
  frames->get_to(results.frames);
  for (const ordered_json& arm : summary.at("arms")) results.arms.push_back(ReadFramesArm(arm));
  const auto reference = summary.find("reference");
  if (reference != summary.end()) ReadPublished(*reference, &results);
  return results;
}

std::vector<TableRow> FramesRows(const FramesResults& results) {
  std::vector<TableRow> rows{{"ARM"}};
  for (const int64_t frames : results.frames) rows[0].push_back(fmt::format("{} [95 %]", frames));
  for (const FramesArm& arm : results.arms) {
    rows.push_back({arm.name});
    for (const int64_t frames : results.frames) {
      rows.back().push_back(FormatReturn(FiguresAt(arm, frames)));
    }
  }
  if (!AreDifferentTasks(results.arms)) return rows;
  rows.push_back({MeanLabel(results)});
  for (const int64_t frames : results.frames) {
    rows.back().push_back(FormatReturn(MeanOfTasksAt(results.arms, frames)));
  }
  return rows;
}

std::vector<TableRow> PublishedRows(const FramesResults& results, int64_t frames) {
  const std::vector<std::string> methods = MethodsOf(results);
  const auto cell = [](const std::optional<double>& value) {
    return value ? FormatValue(*value) : "-";
  };
  std::vector<TableRow> rows{{"TASK"}};
  for (const std::string& method : methods) rows[0].push_back(method);
  for (const std::string& task : TasksOf(results)) {
    rows.push_back({task});
    for (const std::string& method : methods) {
      rows.back().push_back(cell(PublishedAt(results, method, task, frames)));
    }
  }
  if (!AreDifferentTasks(results.arms)) return rows;
  rows.push_back({MeanLabel(results)});
  for (const std::string& method : methods) {
    rows.back().push_back(cell(PublishedMeanAt(results, method, frames)));
  }
  return rows;
}

std::vector<int64_t> PublishedFrames(const FramesResults& results) {
  std::vector<int64_t> published;
  for (const int64_t frames : results.frames) {
    const bool any = std::ranges::find(results.published, frames, &PublishedReturn::frames) !=
                     results.published.end();
    if (any) published.push_back(frames);
  }
  return published;
}

std::string FramesText(const FramesResults& results) {
  if (results.frames.empty()) return "";
  std::string text = "mean return at environment frames (env steps x action repeat):\n" +
                     AlignedTable(FramesRows(results));
  for (const int64_t frames : PublishedFrames(results)) {
    text += fmt::format("reference {} at {} environment frames:\n", results.reference, frames) +
            AlignedTable(PublishedRows(results, frames));
  }
  return text;
}

}  // namespace shoal::launch
