#include "launch/report/subjects.h"

#include <algorithm>

#include "common/base/error.h"
#include "launch/experiment/experiment_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

bool IsRun(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / "config.json", error);
}

bool IsEvaluated(const RunResults& run) { return run.final || !run.curve.empty(); }

RunGroup GroupOfRun(const fs::path& folder) {
  RunGroup group;
  group.runs.push_back(ReadRunResults(folder));
  group.name = group.runs[0].name;
  if (!IsEvaluated(group.runs[0])) {
    throw UsageError("run '{}' has no evaluations: nothing to compare or draw", folder.string());
  }
  return group;
}

std::vector<RunGroup> GroupsOfExperiment(const fs::path& folder, bool full_names) {
  const StoredExperiment experiment = ReadExperiment(folder);
  std::vector<RunGroup> groups;
  for (const Arm& arm : experiment.definition.arms) {
    groups.push_back({.name = full_names ? experiment.definition.name + "/" + arm.name : arm.name});
  }
  bool any = false;
  for (const ExperimentRun& run : experiment.Runs()) {
    RunGroup& group = groups[run.arm];
    if (IsRun(run.folder)) {
      RunResults results = ReadRunResults(run.folder);
      if (IsEvaluated(results)) {
        group.runs.push_back(std::move(results));
        any = true;
        continue;
      }
    }
    group.unevaluated.push_back(run.name);
  }
  if (!any) {
    throw UsageError("experiment '{}' has no evaluations: nothing to compare or draw",
                     folder.string());
  }
  return groups;
}

}  // namespace

std::vector<RunGroup> ReadSubjects(const SubjectOptions& options) {
  std::vector<RunGroup> groups;
  for (size_t i = 0; i < options.names.size(); ++i) {
    const std::string& name = options.names[i];
    if (std::count(options.names.begin(), options.names.begin() + ptrdiff_t(i), name) > 0) {
      throw UsageError("'{}' is given twice", name);
    }
    const fs::path run = fs::path(options.run_dir) / name;
    const fs::path experiment = fs::path(options.experiment_dir) / name;
    std::vector<RunGroup> found;
    for (const fs::path& path : {run, experiment, fs::path(name)}) {
      if (!found.empty()) break;
      if (IsRun(path)) {
        found = {GroupOfRun(path)};
      } else if (IsExperiment(path)) {
        found = GroupsOfExperiment(path, options.names.size() > 1);
      }
    }
    if (found.empty()) {
      throw UsageError("no run or experiment '{}': neither '{}', '{}' nor '{}' is one", name,
                       run.string(), experiment.string(), name);
    }
    std::ranges::move(found, std::back_inserter(groups));
  }
  return groups;
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
