// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/report/reference_curves.h"

#include <algorithm>

#include "launch/tools/experiment/environment_frames.h"

namespace shoal::launch {
namespace {

// Evaluations are a little late, so the last point of a paper may be a little beyond the budget.
constexpr double kMargin = 1.02;

// A task of a picture.
struct TaskScale {
  std::string task;
  size_t group = 0;  // the first group of the task
  std::vector<int> repeats{};
  double end_frames = 0;  // environment frames at the end of the longest run
};

void Extend(const RunResults& run, TaskScale* scale) {
  const int repeat = ActionRepeatOf(run.config);
  if (std::ranges::count(scale->repeats, repeat) == 0) scale->repeats.push_back(repeat);
  auto end = static_cast<double>(run.config.env_steps);
  if (!run.curve.empty()) end = std::max(end, static_cast<double>(run.curve.back().env_steps));
  scale->end_frames = std::max(scale->end_frames, end * repeat);
}

std::vector<TaskScale> ScalesOf(const std::vector<RunGroup>& groups) {
  std::vector<TaskScale> scales;
  for (size_t g = 0; g < groups.size(); ++g) {
    for (const RunResults& run : groups[g].runs) {
      auto scale = std::ranges::find(scales, run.config.task, &TaskScale::task);
      if (scale == scales.end()) {
        scale = scales.insert(scales.end(), {.task = run.config.task, .group = g});
      }
      Extend(run, &*scale);
    }
  }
  return scales;
}

std::vector<ReferencePoint> PointsOf(const ReferenceResult& result, const TaskScale& scale,
                                     PlotAxis axis) {
  const double divisor = axis == PlotAxis::kFrames ? 1 : scale.repeats[0];
  std::vector<ReferencePoint> points;
  for (size_t i = 0; i < result.frames.size(); ++i) {
    const auto frames = static_cast<double>(result.frames[i]);
    if (frames <= kMargin * scale.end_frames) {
      points.push_back({frames / divisor, result.returns[i]});
    }
  }
  return points;
}

// Position of the method in the list, to which a new one is added.
size_t NumberOf(const std::string& method, std::vector<std::string>* methods) {
  const auto at = std::ranges::find(*methods, method) - methods->begin();
  if (at == std::ssize(*methods)) methods->push_back(method);
  return static_cast<size_t>(at);
}

}  // namespace

std::vector<ReferenceCurve> ReferenceCurvesOf(const std::vector<Reference>& references,
                                              const std::vector<RunGroup>& groups, PlotAxis axis) {
  std::vector<ReferenceCurve> curves;
  if (references.empty() || (axis != PlotAxis::kFrames && axis != PlotAxis::kEnvSteps)) {
    return curves;
  }
  const std::vector<TaskScale> scales = ScalesOf(groups);
  std::vector<std::string> methods;
  for (const Reference& reference : references) {
    for (const ReferenceResult& result : reference.results) {
      const auto scale = std::ranges::find(scales, result.task, &TaskScale::task);
      if (scale == scales.end()) continue;
      if (axis == PlotAxis::kEnvSteps && scale->repeats.size() > 1) continue;
      ReferenceCurve curve{.title = result.method, .points = PointsOf(result, *scale, axis)};
      if (scales.size() > 1) {
        curve.title += ", " + result.task;
        curve.group = scale->group;
      }
      if (curve.points.empty()) continue;
      curve.method = NumberOf(result.method, &methods);
      curves.push_back(std::move(curve));
    }
  }
  return curves;
}

}  // namespace shoal::launch
