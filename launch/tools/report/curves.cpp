// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/report/curves.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "launch/tools/experiment/environment_frames.h"
#include "launch/tools/experiment/statistics_json.h"

namespace shoal::launch {
namespace {

struct Sample {
  double x, y;
};

// An axis of one run.
struct RunAxis {
  PlotAxis axis;
  int action_repeat = 1;  // only for the axis of frames
};

RunAxis AxisOf(PlotAxis axis, const RunResults& run) {
  return {axis, axis == PlotAxis::kFrames ? ActionRepeatOf(run.config) : 1};
}

// Position of an evaluation or a RolloutPoint on the axis.
double Along(const RunAxis& axis, const auto& point) {
  switch (axis.axis) {
    case PlotAxis::kEnvSteps:
      return static_cast<double>(point.env_steps);
    case PlotAxis::kFrames:
      return static_cast<double>(point.env_steps) * axis.action_repeat;
    case PlotAxis::kUpdates:
      return static_cast<double>(point.updates);
    case PlotAxis::kWallMinutes:
      return point.wall_seconds / 60;
  }
  return 0;
}

std::optional<double> Percent(const std::optional<double>& rate) {
  return rate ? std::optional(100 * *rate) : std::nullopt;
}

std::optional<double> Value(PlotFigure figure, const EvaluationFigures& point) {
  switch (figure) {
    case PlotFigure::kSuccess:
      return Percent(point.success);
    case PlotFigure::kReturn:
      return point.return_mean;
    case PlotFigure::kFinalDistance:
      if (!point.final_distance_mean) return std::nullopt;
      return Centimetres(*point.final_distance_mean);
  }
  return std::nullopt;
}

std::optional<double> Value(PlotFigure figure, const RolloutPoint& point) {
  switch (figure) {
    case PlotFigure::kSuccess:
      return Percent(point.success);
    case PlotFigure::kReturn:
      return point.episode_return;
    case PlotFigure::kFinalDistance:
      return std::nullopt;  // not recorded
  }
  return std::nullopt;
}

std::vector<Sample> SamplesOf(const auto& points, const RunAxis& axis, PlotFigure figure) {
  std::vector<Sample> samples;
  for (const auto& point : points) {
    const auto value = Value(figure, point);
    if (value && std::isfinite(*value)) samples.push_back({Along(axis, point), *value});
  }
  std::ranges::stable_sort(samples, {}, &Sample::x);
  return samples;
}

// Interpolates linearly between samples; empty outside of their range.
std::optional<double> At(const std::vector<Sample>& samples, double x) {
  if (samples.empty() || x < samples.front().x || x > samples.back().x) return std::nullopt;
  const auto above = std::ranges::lower_bound(samples, x, {}, &Sample::x);
  if (above->x == x) return above->y;
  const auto below = above - 1;
  return below->y + (above->y - below->y) * (x - below->x) / (above->x - below->x);
}

// Mean and range of the seeds' curves, at the union of the curves' points.
std::vector<CurvePoint> OverSeeds(const std::vector<std::vector<Sample>>& seeds, size_t points) {
  std::vector<double> xs;
  for (const auto& samples : seeds) {
    for (const Sample& sample : samples) xs.push_back(sample.x);
  }
  std::ranges::sort(xs);
  xs.erase(std::unique(xs.begin(), xs.end()), xs.end());
  const size_t stride = std::max<size_t>(1, (xs.size() + points - 1) / points);
  std::vector<CurvePoint> curve;
  for (size_t i = 0; i < xs.size(); ++i) {
    if (i % stride != 0 && i + 1 != xs.size()) continue;  // the last point is always kept
    CurvePoint point{.x = xs[i]};
    for (const auto& samples : seeds) {
      const auto value = At(samples, xs[i]);
      if (!value) continue;
      point.low = point.seeds == 0 ? *value : std::min(point.low, *value);
      point.high = point.seeds == 0 ? *value : std::max(point.high, *value);
      point.mean += *value;
      ++point.seeds;
    }
    if (point.seeds == 0) continue;
    point.mean /= static_cast<double>(point.seeds);
    curve.push_back(point);
  }
  return curve;
}

}  // namespace

std::vector<CurvePoint> CurveOf(const RunGroup& group, PlotAxis axis, PlotFigure figure,
                                size_t points) {
  std::vector<std::vector<Sample>> seeds;
  for (const RunResults& run : group.runs) {
    seeds.push_back(SamplesOf(run.curve, AxisOf(axis, run), figure));
  }
  return OverSeeds(seeds, points);
}

std::vector<CurvePoint> RolloutCurveOf(const RunGroup& group, PlotAxis axis, PlotFigure figure,
                                       size_t points) {
  std::vector<std::vector<Sample>> seeds;
  for (const RunResults& run : group.runs) {
    seeds.push_back(SamplesOf(run.rollouts, AxisOf(axis, run), figure));
  }
  return OverSeeds(seeds, points);
}

void ReadRollouts(std::vector<RunGroup>* groups) {
  for (RunGroup& group : *groups) {
    for (RunResults& run : group.runs) run.rollouts = ReadRolloutCurve(run.folder);
  }
}

std::vector<PlotFigure> FiguresThereAre(const std::vector<RunGroup>& groups) {
  std::vector<PlotFigure> figures;
  for (const PlotFigure figure :
       {PlotFigure::kSuccess, PlotFigure::kReturn, PlotFigure::kFinalDistance}) {
    const bool any = std::ranges::any_of(groups, [&](const RunGroup& group) {
      return !CurveOf(group, PlotAxis::kEnvSteps, figure).empty();
    });
    if (any) figures.push_back(figure);
  }
  return figures;
}

}  // namespace shoal::launch
