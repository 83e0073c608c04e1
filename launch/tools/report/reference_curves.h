// SPDX-License-Identifier: Apache-2.0
// Published results as curves of a picture, beside the curves of groups of runs.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "launch/tools/experiment/reference.h"
#include "launch/tools/report/curves.h"
#include "launch/tools/report/subjects.h"

namespace shoal::launch {

struct ReferencePoint {
  double x = 0, value = 0;
};

struct ReferenceCurve {
  std::string title{};  // the method; "METHOD, TASK" if the groups have different tasks
  size_t method = 0;    // number of the method in this picture; its curves have the same markers
  // The group whose colour the curve has: the first one of the same task. Empty, for grey, if all
  // groups have the same task.
  std::optional<size_t> group{};
  std::vector<ReferencePoint> points{};  // at least one
};

// Curves of the published mean returns on tasks of the groups, along `axis`. Points beyond the end
// of the runs are left out: the end is the budget, or the last evaluation if that is later. Empty
// on the axes of updates and wall time, which papers do not state. On the axis of env steps, a task
// is left out if its groups have different action repeats. Throws Error if ActionRepeatOf does.
std::vector<ReferenceCurve> ReferenceCurvesOf(const std::vector<Reference>& references,
                                              const std::vector<RunGroup>& groups, PlotAxis axis);

}  // namespace shoal::launch
