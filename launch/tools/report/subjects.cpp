// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/report/subjects.h"

#include <algorithm>
#include <array>

#include "common/base/error.h"
#include "launch/record/run_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

bool IsEvaluated(const RunResults& run) { return run.final || !run.curve.empty(); }

void Sort(ExperimentRunStatus standing, const std::string& run, RunGroup* group) {
  if (standing == ExperimentRunStatus::kFailed) {
    group->failed.push_back(run);
  } else if (standing != ExperimentRunStatus::kFinished) {
    group->unfinished.push_back(run);
  }
}

RunGroup GroupOfRun(const fs::path& folder) {
  RunGroup group;
  group.runs.push_back(ReadRunResults(folder));
  group.name = group.runs[0].name;
  if (!IsEvaluated(group.runs[0])) {
    throw UsageError("run '{}' has no evaluations: nothing to compare or draw", folder.string());
  }
  Sort(StandingOf(folder, nullptr).standing, group.name, &group);
  return group;
}

std::vector<RunGroup> GroupsOfExperiment(const StoredExperiment& experiment, bool full_names) {
  const auto log = experiment.Log().Read();
  std::vector<RunGroup> groups;
  for (const Arm& arm : experiment.definition.arms) {
    groups.push_back({.name = full_names ? experiment.definition.name + "/" + arm.name : arm.name});
  }
  bool any = false;
  for (const ExperimentRun& run : experiment.Runs()) {
    RunGroup& group = groups[run.arm];
    const ExperimentRunStatus standing = experiment.Standing(run, log).standing;
    if (IsRun(run.folder)) {
      RunResults results = ReadRunResults(run.folder);
      if (IsEvaluated(results)) {
        Sort(standing, run.name, &group);
        group.runs.push_back(std::move(results));
        any = true;
        continue;
      }
    }
    if (standing == ExperimentRunStatus::kFailed) {
      group.failed.push_back(run.name);
    } else {
      group.unevaluated.push_back(run.name);
    }
  }
  if (!any) {
    throw UsageError("experiment '{}' has no evaluations: nothing to compare or draw",
                     experiment.folder.string());
  }
  return groups;
}

}  // namespace

Subjects ReadSubjects(const SubjectOptions& options) {
  const std::array kinds{RunsIn(options.run_dir), ExperimentsIn(options.experiment_dir)};
  Subjects subjects;
  for (const std::string& name : options.names) {
    if (std::ranges::count(options.names, name) > 1) throw UsageError("'{}' is given twice", name);
    const fs::path folder = FindNamed(name, kinds);
    Subject subject{.name = NamedFolder(folder).filename()};
    std::vector<RunGroup> groups;
    if (IsRun(folder)) {
      groups = {GroupOfRun(folder)};
    } else {
      subject.experiment = ReadExperiment(folder);
      groups = GroupsOfExperiment(*subject.experiment, options.names.size() > 1);
    }
    subjects.named.push_back(std::move(subject));
    std::ranges::move(groups, std::back_inserter(subjects.groups));
  }
  return subjects;
}

std::vector<std::string> TasksOf(const std::vector<RunGroup>& groups) {
  std::vector<std::string> tasks;
  for (const RunGroup& group : groups) {
    for (const RunResults& run : group.runs) {
      if (std::ranges::count(tasks, run.config.task) == 0) tasks.push_back(run.config.task);
    }
  }
  return tasks;
}

void CheckOneTask(const std::vector<RunGroup>& groups) {
  const RunResults* first = nullptr;
  for (const RunGroup& group : groups) {
    for (const RunResults& run : group.runs) {
      if (first == nullptr) first = &run;
      if (run.config.task == first->config.task) continue;
      throw UsageError("mixed tasks: '{}' is of {}, '{}' of {}: their figures do not compare",
                       first->name, first->config.task, run.name, run.config.task);
    }
  }
}

}  // namespace shoal::launch
