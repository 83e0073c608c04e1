// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/report/report_curves.h"

#include <algorithm>

#include "common/base/files.h"
#include "launch/processes/scratch_folder.h"
#include "launch/tools/report/plot.h"

namespace shoal::launch {
namespace {

struct TaskGroups {
  std::string task;
  std::vector<RunGroup> groups{};
};

// A group without runs has the task of the group before, or the first task, so that the pictures of
// a report with one task have the colours of all groups.
std::vector<TaskGroups> SplitByTask(const std::vector<RunGroup>& groups) {
  const auto has_runs = [](const RunGroup& group) { return !group.runs.empty(); };
  const auto first = std::ranges::find_if(groups, has_runs);
  std::vector<TaskGroups> tasks;
  if (first == groups.end()) return tasks;
  std::string task = first->runs[0].config.task;
  for (const RunGroup& group : groups) {
    if (has_runs(group)) task = group.runs[0].config.task;
    auto same = std::ranges::find(tasks, task, &TaskGroups::task);
    if (same == tasks.end()) same = tasks.insert(tasks.end(), {.task = task});
    same->groups.push_back(group);
  }
  return tasks;
}

}  // namespace

std::vector<std::string> DrawReportCurves(const std::vector<RunGroup>& groups,
                                          const ReportCurvesOptions& options) {
  std::vector<std::string> pictures;
  const ScratchFolder scratch;
  const std::filesystem::path file = scratch.path() / "curves.svg";
  const PlotAxis steps = options.over_frames ? PlotAxis::kFrames : PlotAxis::kEnvSteps;
  for (const TaskGroups& task : SplitByTask(groups)) {
    const std::vector<PlotFigure> figures = FiguresThereAre(task.groups);
    for (const PlotAxis axis : {steps, PlotAxis::kWallMinutes}) {
      if (figures.empty()) break;
      Draw({.title = task.task, .axis = axis, .figures = figures, .references = options.references},
           task.groups, file);
      pictures.push_back(ReadFile(file));
    }
  }
  return pictures;
}

}  // namespace shoal::launch
