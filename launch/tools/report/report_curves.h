// SPDX-License-Identifier: Apache-2.0
// Pictures of learning curves for a report.
#pragma once

#include <string>
#include <vector>

#include "launch/tools/experiment/reference.h"
#include "launch/tools/report/subjects.h"

namespace shoal::launch {

struct ReportCurvesOptions {
  bool over_frames = false;             // environment frames instead of env steps
  std::vector<Reference> references{};  // published results to draw
};

// One SVG document for each task of the groups and each axis: env steps or environment frames, to
// compare algorithms, and wall time, to compare waiting times. The title is the task. Tasks without
// values are left out. Throws the errors of Draw (plot.h).
std::vector<std::string> DrawReportCurves(const std::vector<RunGroup>& groups,
                                          const ReportCurvesOptions& options);

}  // namespace shoal::launch
