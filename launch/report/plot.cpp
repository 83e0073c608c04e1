// SPDX-License-Identifier: Apache-2.0
#include "launch/report/plot.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <sstream>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/stop.h"
#include "launch/experiment/statistics_json.h"
#include "launch/processes/child_process.h"
#include "launch/processes/scratch_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kDeadline{120};
constexpr int kWidth = 900, kPanelHeight = 330;

// Told apart by people with any colour vision, and on paper (Wong 2011, Nature Methods 8:441).
constexpr std::array kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                 "#E69F00", "#56B4E9", "#000000"};

struct Sample {
  double x, y;
};

double Along(PlotAxis axis, const EvaluationFigures& point) {
  switch (axis) {
    case PlotAxis::kEnvSteps:
      return static_cast<double>(point.env_steps);
    case PlotAxis::kUpdates:
      return static_cast<double>(point.updates);
    case PlotAxis::kWallMinutes:
      return point.wall_seconds / 60;
  }
  return 0;
}

std::optional<double> Value(PlotFigure figure, const EvaluationFigures& point) {
  switch (figure) {
    case PlotFigure::kSuccess:
      if (!point.success) return std::nullopt;
      return 100 * *point.success;
    case PlotFigure::kReturn:
      return point.return_mean;
    case PlotFigure::kFinalDistance:
      if (!point.final_distance_mean) return std::nullopt;
      return Centimetres(*point.final_distance_mean);
  }
  return std::nullopt;
}

std::vector<Sample> SamplesOf(const RunResults& run, PlotAxis axis, PlotFigure figure) {
  std::vector<Sample> samples;
  for (const EvaluationFigures& point : run.curve) {
    const auto value = Value(figure, point);
    if (value && std::isfinite(*value)) samples.push_back({Along(axis, point), *value});
  }
  std::ranges::stable_sort(samples, {}, &Sample::x);
  return samples;
}

// Linear between samples; empty outside of them.
std::optional<double> At(const std::vector<Sample>& samples, double x) {
  if (samples.empty() || x < samples.front().x || x > samples.back().x) return std::nullopt;
  const auto above = std::ranges::lower_bound(samples, x, {}, &Sample::x);
  if (above->x == x) return above->y;
  const auto below = above - 1;
  return below->y + (above->y - below->y) * (x - below->x) / (above->x - below->x);
}

const char* AxisLabel(PlotAxis axis) {
  switch (axis) {
    case PlotAxis::kEnvSteps:
      return "env steps";
    case PlotAxis::kUpdates:
      return "updates";
    case PlotAxis::kWallMinutes:
      return "wall time, minutes";
  }
  return "";
}

const char* FigureLabel(PlotFigure figure) {
  switch (figure) {
    case PlotFigure::kSuccess:
      return "success, %";
    case PlotFigure::kReturn:
      return "mean return";
    case PlotFigure::kFinalDistance:
      return "final distance, cm";
  }
  return "";
}

// In gnuplot's single quotes, in which nothing but '' means anything else than itself: double
// quotes would run what is in backticks as a shell command. Control characters are for nobody's
// terminal.
std::string Quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') quoted += '\'';
    quoted += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return quoted + "'";
}

std::string BlockName(size_t group, size_t figure) {
  return fmt::format("$curve_{}_{}", group, figure);
}

std::string DataBlock(const std::string& name, const std::vector<CurvePoint>& curve) {
  std::string block = name + " << EOD\n";
  for (const CurvePoint& p : curve) {
    block += fmt::format("{:.10g} {:.10g} {:.10g} {:.10g}\n", p.x, p.mean, p.low, p.high);
  }
  return block + "EOD\n";
}

std::string SeedsOf(const RunGroup& group) {
  return fmt::format("{} ({} seed{})", group.name, group.runs.size(),
                     group.runs.size() == 1 ? "" : "s");
}

// Bands first: no line is hidden by another group's band.
std::string PanelCommands(const std::vector<RunGroup>& groups, size_t figure,
                          const std::vector<bool>& drawn, bool legend) {
  std::vector<std::string> parts;
  for (size_t g = 0; g < groups.size(); ++g) {
    if (!drawn[g] || groups[g].runs.size() < 2) continue;
    parts.push_back(
        fmt::format("{} using 1:3:4 with filledcurves fc rgb '{}' fs transparent solid "
                    "0.18 noborder notitle",
                    BlockName(g, figure), kColours[g % kColours.size()]));
  }
  for (size_t g = 0; g < groups.size(); ++g) {
    if (!drawn[g]) continue;
    parts.push_back(fmt::format("{} using 1:2 with linespoints lw 2 pt 7 ps 0.35 lc rgb '{}' {}",
                                BlockName(g, figure), kColours[g % kColours.size()],
                                legend ? "title " + Quoted(SeedsOf(groups[g])) : "notitle"));
  }
  std::string commands = "plot ";
  for (size_t i = 0; i < parts.size(); ++i) commands += (i == 0 ? "" : ", \\\n  ") + parts[i];
  return commands + "\n";
}

bool OnPath(const std::string& program) {
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (access((fs::path(folder) / program).c_str(), X_OK) == 0) return true;
  }
  return false;
}

}  // namespace

PlotAxis ParsePlotAxis(const std::string& word) {
  if (word == "env-steps") return PlotAxis::kEnvSteps;
  if (word == "updates") return PlotAxis::kUpdates;
  if (word == "wall") return PlotAxis::kWallMinutes;
  throw UsageError("axis '{}': expected env-steps | updates | wall", word);
}

PlotFigure ParsePlotFigure(const std::string& word) {
  if (word == "success") return PlotFigure::kSuccess;
  if (word == "return") return PlotFigure::kReturn;
  if (word == "distance") return PlotFigure::kFinalDistance;
  throw UsageError("figure '{}': expected success | return | distance", word);
}

std::vector<CurvePoint> CurveOf(const RunGroup& group, PlotAxis axis, PlotFigure figure,
                                size_t points) {
  std::vector<std::vector<Sample>> seeds;
  std::vector<double> xs;
  for (const RunResults& run : group.runs) {
    seeds.push_back(SamplesOf(run, axis, figure));
    for (const Sample& sample : seeds.back()) xs.push_back(sample.x);
  }
  std::ranges::sort(xs);
  xs.erase(std::unique(xs.begin(), xs.end()), xs.end());
  const size_t stride = std::max<size_t>(1, (xs.size() + points - 1) / points);
  std::vector<CurvePoint> curve;
  for (size_t i = 0; i < xs.size(); ++i) {
    if (i % stride != 0 && i + 1 != xs.size()) continue;  // the last one always
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

std::string PlotScript(const Plot& plot, const std::vector<RunGroup>& groups,
                       const fs::path& output) {
  const std::string ending = output.extension();
  if (ending != ".png" && ending != ".svg") {
    throw UsageError("'{}': expected a file that ends in .png or .svg", output.string());
  }
  const size_t panels = plot.figures.size();
  const size_t height = kPanelHeight * panels + 60;
  std::string script =
      ending == ".png"
          ? fmt::format("set terminal pngcairo size {},{} font 'DejaVu Sans,11' enhanced\n", kWidth,
                        height)
          : fmt::format(
                "set terminal svg size {},{} dynamic font 'DejaVu Sans,13' enhanced "
                "background rgb 'white'\n",
                kWidth, height);
  script += "set output " + Quoted(output) + "\nset encoding utf8\n";
  std::vector<std::vector<bool>> drawn(panels, std::vector<bool>(groups.size()));
  for (size_t f = 0; f < panels; ++f) {
    bool any = false;
    for (size_t g = 0; g < groups.size(); ++g) {
      const auto curve = CurveOf(groups[g], plot.axis, plot.figures[f]);
      drawn[f][g] = !curve.empty();
      any |= drawn[f][g];
      if (drawn[f][g]) script += DataBlock(BlockName(g, f), curve);
    }
    if (!any) {
      throw UsageError("no run has evaluations with {} to draw", FigureLabel(plot.figures[f]));
    }
  }
  script += fmt::format(
      "set border 3 lc rgb '#666666'\nset tics nomirror out textcolor rgb '#333333'\n"
      "set grid lc rgb '#dddddd' lt 1\nset autoscale xfixmax\nset format x '%.10g'\nset "
      "decimalsign '.'\n"
      "set lmargin 10\nset rmargin 4\n"
      "set key outside top center horizontal noenhanced samplen 2\n"
      "set multiplot layout {},1 title {} noenhanced font ',13'\n",
      panels, Quoted(plot.title));
  for (size_t f = 0; f < panels; ++f) {
    const bool last = f + 1 == panels;
    const bool success = plot.figures[f] == PlotFigure::kSuccess;
    script += fmt::format("set ylabel {}\nset yrange [{}]\nset xlabel {}\n",
                          Quoted(FigureLabel(plot.figures[f])),
                          success                                         ? "0:102"
                          : plot.figures[f] == PlotFigure::kFinalDistance ? "0:*"
                                                                          : "*:*",
                          last ? Quoted(AxisLabel(plot.axis)) : "''");
    script += PanelCommands(groups, f, drawn[f], f == 0);
  }
  return script + "unset multiplot\n";
}

void Draw(const Plot& plot, const std::vector<RunGroup>& groups, const fs::path& output) {
  CheckWritable(output);
  const ScratchFolder scratch;
  // Drawn beside it and moved there: a reader sees the old picture or the new one.
  const fs::path script = scratch.path() / "plot.gp",
                 drawn = scratch.path() / ("plot" + output.extension().string());
  WriteFileAtomically(script, PlotScript(plot, groups, drawn));
  if (!OnPath("gnuplot")) {
    throw RuntimeError("gnuplot is not installed: plots need it (Debian: apt install gnuplot-nox)");
  }
  ProcessSpec spec;
  spec.command = {"/usr/bin/env", "gnuplot", script.string()};
  spec.output = scratch.path() / "said";
  const auto status = RunToEnd(spec, kDeadline, StopRequested);
  if (!status || !status->Clean() || !fs::exists(drawn)) {
    throw RuntimeError("gnuplot: {}: {}", status ? status->Describe() : "did not end",
                       LastLine(spec.output));
  }
  WriteFileForOthers(output, ReadFile(drawn));
}

}  // namespace shoal::launch
