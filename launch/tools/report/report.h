// SPDX-License-Identifier: Apache-2.0
// `shoal report`: one HTML page that needs nothing but itself: what was asked, figures with
// intervals, curves, films, configuration, machine, builds, the commands that repeat it.
#pragma once

#include <string>
#include <vector>

#include "launch/tools/report/compare.h"

namespace shoal::launch {

struct ReportContent {
  std::string title{}, question{};
  Comparison comparison{};
  std::vector<RunGroup> groups{};
  std::vector<Definition> definitions{};  // of the experiments among the subjects
  std::vector<std::string> commands{};    // that repeat it
  std::vector<std::string> curves{};      // SVG documents, one for each axis; none without figures
};

// Reads the subjects and has their curves drawn. Throws Error: as ReadSubjects and Draw; mixed
// tasks unless they are those of one experiment.
ReportContent GatherReport(const SubjectOptions& options);

// Everything from outside is escaped.
std::string ReportHtml(const ReportContent& content);

}  // namespace shoal::launch
