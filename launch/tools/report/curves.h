// SPDX-License-Identifier: Apache-2.0
// Learning curves of groups of runs: mean and range over the seeds.
#pragma once

#include <cstddef>
#include <vector>

#include "launch/tools/report/subjects.h"

namespace shoal::launch {

enum class PlotAxis {
  kEnvSteps,
  kFrames,  // environment frames: env steps x action repeat (environment_frames.h)
  kUpdates,
  kWallMinutes,
};
enum class PlotFigure { kSuccess, kReturn, kFinalDistance };

struct CurvePoint {
  double x = 0;
  double mean = 0, low = 0, high = 0;  // over the seeds: mean, smallest, largest
  size_t seeds = 0;                    // number of seeds whose curves extend to x
};

// Curve of one group's evaluations during training, over `axis`. Each seed's curve is linear
// between its evaluations and ends with the last evaluation. The group's curve has a point at each
// evaluation of any seed, reduced to at most `points`. Empty if no run has values of `figure`. On
// the axis of frames, throws Error if ActionRepeatOf does.
std::vector<CurvePoint> CurveOf(const RunGroup& group, PlotAxis axis, PlotFigure figure,
                                size_t points = 200);

// Reads metrics.jsonl of each run into its `rollouts`.
void ReadRollouts(std::vector<RunGroup>* groups);

// Curve of the training episodes, which the actors play with exploration, from the runs'
// `rollouts`. Empty for the final distance, which is not recorded.
std::vector<CurvePoint> RolloutCurveOf(const RunGroup& group, PlotAxis axis, PlotFigure figure,
                                       size_t points = 200);

// Those of success, return and distance, in this order, that at least one run has.
std::vector<PlotFigure> FiguresThereAre(const std::vector<RunGroup>& groups);

}  // namespace shoal::launch
