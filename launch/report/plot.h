// SPDX-License-Identifier: Apache-2.0
// `shoal plot`: learning curves with bands over seeds, drawn by gnuplot.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "launch/report/subjects.h"

namespace shoal::launch {

enum class PlotAxis { kEnvSteps, kUpdates, kWallMinutes };
enum class PlotFigure { kSuccess, kReturn, kFinalDistance };

// Throw Error (usage) naming the word and those there are.
PlotAxis ParsePlotAxis(const std::string& word);      // env-steps | updates | wall
PlotFigure ParsePlotFigure(const std::string& word);  // success | return | distance

struct CurvePoint {
  double x = 0;
  double mean = 0, low = 0, high = 0;  // over the seeds: mean, smallest, largest
  size_t seeds = 0;                    // that reach to x
};

// One group's evaluations while training over `axis`. Each seed's curve is linear between its
// evaluations and ends with them; the points are those of all seeds, thinned to at most `points`.
// Empty where no run has the figure.
std::vector<CurvePoint> CurveOf(const RunGroup& group, PlotAxis axis, PlotFigure figure,
                                size_t points = 200);

struct Plot {
  std::string title{};
  PlotAxis axis = PlotAxis::kEnvSteps;
  std::vector<PlotFigure> figures{};  // one below the other
};

// Figures that any of the runs has, in the order success, return, distance.
std::vector<PlotFigure> FiguresThereAre(const std::vector<RunGroup>& groups);

// Commands for gnuplot with the data in them; `output` as png or svg, by its ending. Throws Error
// (usage) where no run has a figure.
std::string PlotScript(const Plot& plot, const std::vector<RunGroup>& groups,
                       const std::filesystem::path& output);

// Draws the picture. Throws Error: gnuplot is not installed, fails, or the file cannot be written.
void Draw(const Plot& plot, const std::vector<RunGroup>& groups,
          const std::filesystem::path& output);

}  // namespace shoal::launch
