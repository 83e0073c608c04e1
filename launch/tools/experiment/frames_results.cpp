// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/frames_results.h"

#include <algorithm>
#include <map>
#include <set>

namespace shoal::launch {
namespace {

// Empty if the run has no evaluation near these frames.
std::optional<double> ReturnOf(const FramesRun& run, int64_t frames) {
  const auto found = std::ranges::find(run.returns, frames, &ReturnAtFrames::frames);
  return found == run.returns.end() ? std::nullopt : std::optional(found->return_mean);
}

bool HasTask(const std::vector<FramesArm>& arms, const std::string& task) {
  return std::ranges::find(arms, task, &FramesArm::task) != arms.end();
}

}  // namespace

std::vector<ReturnAtFrames> ReturnsAtFrames(const RunResults& run,
                                            const std::vector<int64_t>& frames) {
  std::vector<ReturnAtFrames> returns;
  if (frames.empty()) return returns;
  const int repeat = ActionRepeatOf(run.config);
  for (const int64_t one : frames) {
    if (const auto found = FindReturnAt(one, run.curve, repeat)) returns.push_back(*found);
  }
  return returns;
}

void SetReference(const Reference& reference, FramesResults* results) {
  results->reference = reference.name;
  results->source = reference.source;
  results->published.clear();
  for (const ReferenceResult& result : reference.results) {
    if (!HasTask(results->arms, result.task)) continue;
    for (size_t i = 0; i < result.frames.size(); ++i) {
      if (std::ranges::count(results->frames, result.frames[i]) == 0) continue;
      results->published.push_back(
          {result.method, result.task, result.frames[i], result.returns[i]});
    }
  }
}

SeedFigures FiguresAt(const FramesArm& arm, int64_t frames) {
  SeedFigures figures;
  for (const FramesRun& run : arm.runs) {
    if (run.failed) {
      ++figures.failed;
    } else if (const auto value = ReturnOf(run, frames)) {
      figures.returns.push_back(*value);
    }
  }
  return figures;
}

bool AreDifferentTasks(const std::vector<FramesArm>& arms) {
  std::set<std::string> tasks;
  for (const FramesArm& arm : arms) tasks.insert(arm.task);
  return arms.size() > 1 && tasks.size() == arms.size();
}

SeedFigures MeanOfTasksAt(const std::vector<FramesArm>& arms, int64_t frames) {
  std::map<int64_t, std::vector<double>> returns;  // by seed, one for each arm that has it
  std::set<int64_t> failed;
  for (const FramesArm& arm : arms) {
    for (const FramesRun& run : arm.runs) {
      if (run.failed) failed.insert(run.seed);
      const auto value = run.failed ? std::nullopt : ReturnOf(run, frames);
      if (value) returns[run.seed].push_back(*value);
    }
  }
  SeedFigures figures;
  figures.failed = failed.size();
  for (const auto& [seed, values] : returns) {
    if (values.size() == arms.size()) figures.returns.push_back(Mean(values));
  }
  return figures;
}

std::vector<std::string> MethodsOf(const FramesResults& results) {
  std::vector<std::string> methods;
  for (const PublishedReturn& one : results.published) {
    if (std::ranges::count(methods, one.method) == 0) methods.push_back(one.method);
  }
  return methods;
}

std::optional<double> PublishedAt(const FramesResults& results, const std::string& method,
                                  const std::string& task, int64_t frames) {
  for (const PublishedReturn& one : results.published) {
    if (one.method == method && one.task == task && one.frames == frames) return one.value;
  }
  return std::nullopt;
}

std::optional<double> PublishedMeanAt(const FramesResults& results, const std::string& method,
                                      int64_t frames) {
  std::vector<double> values;
  for (const FramesArm& arm : results.arms) {
    const auto value = PublishedAt(results, method, arm.task, frames);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values.empty() ? std::nullopt : std::optional(Mean(values));
}

}  // namespace shoal::launch
