// SPDX-License-Identifier: Apache-2.0
// `shoal report`: a self-contained HTML page with the question, results with intervals, curves,
// films, configuration, machine, builds, and the commands that repeat the runs.
#pragma once

#include <string>
#include <vector>

#include "launch/tools/experiment/frames_results.h"
#include "launch/tools/report/compare.h"

namespace shoal::launch {

struct ReportContent {
  std::string title{}, question{};
  Comparison comparison{};
  std::vector<RunGroup> groups{};
  std::vector<Definition> definitions{};  // of the experiments among the subjects
  std::vector<std::string> commands{};    // command lines that repeat the runs
  std::vector<FramesResults> frames{};    // of the experiments whose definitions have frames
  std::vector<Reference> references{};    // drawn among the curves
  std::vector<std::string> problems{};    // why references of definitions are not shown
  std::vector<std::string> curves{};      // SVG documents (report_curves.h)
};

// Reads the subjects and draws their curves, among these references and those of the definitions.
// Throws the errors of ReadSubjects and Draw. Also throws Error if the tasks differ, unless all
// subjects belong to one experiment.
ReportContent GatherReport(const SubjectOptions& options, std::vector<Reference> references = {});

// The HTML page. Text from outside the program is escaped.
std::string ReportHtml(const ReportContent& content);

}  // namespace shoal::launch
