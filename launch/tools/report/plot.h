// SPDX-License-Identifier: Apache-2.0
// `shoal plot`: learning curves with bands over seeds, drawn by gnuplot.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "launch/tools/experiment/reference.h"
#include "launch/tools/report/curves.h"
#include "launch/tools/report/subjects.h"

namespace shoal::launch {

// Both functions throw Error (usage) if the word is unknown; the message lists the possible words.
PlotAxis ParsePlotAxis(const std::string& word);      // env-steps | frames | updates | wall
PlotFigure ParsePlotFigure(const std::string& word);  // success | return | distance

struct Plot {
  std::string title{};
  PlotAxis axis = PlotAxis::kEnvSteps;
  std::vector<PlotFigure> figures{};  // drawn from top to bottom
  // Published results, drawn as dashed lines among the returns (reference_curves.h).
  std::vector<Reference> references{};
};

// Script for gnuplot that contains the data. The extension of `output` selects png or svg. Throws
// Error (usage) if no run has values to draw.
std::string PlotScript(const Plot& plot, const std::vector<RunGroup>& groups,
                       const std::filesystem::path& output);

// Draws the picture. Throws Error if gnuplot is not installed or fails, or if the file cannot be
// written.
void Draw(const Plot& plot, const std::vector<RunGroup>& groups,
          const std::filesystem::path& output);

}  // namespace shoal::launch
