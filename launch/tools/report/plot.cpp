// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/report/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "common/base/error.h"
#include "common/base/files.h"
#include "common/base/search_path.h"
#include "common/base/stop.h"
#include "launch/processes/child_process.h"
#include "launch/processes/scratch_folder.h"
#include "launch/tools/report/reference_curves.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kDeadline{120};
constexpr int kWidth = 900, kPanelHeight = 330;

// Colours that people with any colour vision can distinguish, also on paper (Wong 2011, Nature
// Methods 8:441).
constexpr std::array kColours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                 "#E69F00", "#56B4E9", "#000000"};
constexpr char kGrey[] = "#666666";

const char* AxisLabel(PlotAxis axis) {
  switch (axis) {
    case PlotAxis::kEnvSteps:
      return "env steps";
    case PlotAxis::kFrames:
      return "environment frames (env steps x action repeat)";
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

// Quotes text for gnuplot with single quotes, in which only '' is special. In double quotes,
// gnuplot would run text between backticks as a shell command. Control characters are replaced.
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

std::string RolloutBlockName(size_t group, size_t figure) {
  return fmt::format("$rollouts_{}_{}", group, figure);
}

std::string DataBlock(const std::string& name, const std::vector<CurvePoint>& curve) {
  std::string block = name + " << EOD\n";
  for (const CurvePoint& p : curve) {
    block += fmt::format("{:.10g} {:.10g} {:.10g} {:.10g}\n", p.x, p.mean, p.low, p.high);
  }
  return block + "EOD\n";
}

std::string ReferenceBlockName(size_t curve) { return fmt::format("$reference_{}", curve); }

std::string ReferenceBlock(const std::string& name, const ReferenceCurve& curve) {
  std::string block = name + " << EOD\n";
  for (const ReferencePoint& p : curve.points) {
    block += fmt::format("{:.10g} {:.10g}\n", p.x, p.value);
  }
  return block + "EOD\n";
}

// One plot element for each published curve. Each method has its own marker, because the lines of
// several methods may have the same colour.
std::vector<std::string> ReferenceElements(const std::vector<ReferenceCurve>& curves) {
  constexpr std::array kShapes = {4, 6, 8, 10, 12, 2};
  std::vector<std::string> elements;
  for (size_t i = 0; i < curves.size(); ++i) {
    const auto& group = curves[i].group;
    elements.push_back(
        fmt::format("{} using 1:2 with linespoints dt 2 lw 1 pt {} ps 0.8 lc rgb '{}' title {}",
                    ReferenceBlockName(i), kShapes[curves[i].method % kShapes.size()],
                    group ? kColours[*group % kColours.size()] : kGrey, Quoted(curves[i].title)));
  }
  return elements;
}

std::string SeedsOf(const RunGroup& group) {
  return fmt::format("{} ({} seed{})", group.name, group.runs.size(),
                     group.runs.size() == 1 ? "" : "s");
}

// The curves that a panel shows of a group.
struct Drawn {
  bool evaluations = false, rollouts = false;
};

// Draws bands first and the actors' thin lines next, so that they hide no curve of evaluations.
// `last`: further elements, drawn after the curves.
std::string PanelCommands(const std::vector<RunGroup>& groups, size_t figure,
                          const std::vector<Drawn>& drawn, bool legend,
                          const std::vector<std::string>& last) {
  std::vector<std::string> parts;
  for (size_t g = 0; g < groups.size(); ++g) {
    if (!drawn[g].evaluations || groups[g].runs.size() < 2) continue;
    parts.push_back(
        fmt::format("{} using 1:3:4 with filledcurves fc rgb '{}' fs transparent solid "
                    "0.18 noborder notitle",
                    BlockName(g, figure), kColours[g % kColours.size()]));
  }
  for (size_t g = 0; g < groups.size(); ++g) {
    if (!drawn[g].rollouts) continue;
    parts.push_back(fmt::format("{} using 1:2 with lines lw 1 lc rgb '{}' notitle",
                                RolloutBlockName(g, figure), kColours[g % kColours.size()]));
  }
  for (size_t g = 0; g < groups.size(); ++g) {
    if (!drawn[g].evaluations) continue;
    parts.push_back(fmt::format("{} using 1:2 with linespoints lw 2 pt 7 ps 0.35 lc rgb '{}' {}",
                                BlockName(g, figure), kColours[g % kColours.size()],
                                legend ? "title " + Quoted(SeedsOf(groups[g])) : "notitle"));
  }
  if (legend && std::ranges::any_of(drawn, &Drawn::rollouts)) {
    parts.push_back(
        fmt::format("NaN with lines lw 1 lc rgb '{}' title 'thin: episodes of the actors'", kGrey));
  }
  parts.insert(parts.end(), last.begin(), last.end());
  std::string commands = "plot ";
  for (size_t i = 0; i < parts.size(); ++i) commands += (i == 0 ? "" : ", \\\n  ") + parts[i];
  return commands + "\n";
}

}  // namespace

PlotAxis ParsePlotAxis(const std::string& word) {
  if (word == "env-steps") return PlotAxis::kEnvSteps;
  if (word == "frames") return PlotAxis::kFrames;
  if (word == "updates") return PlotAxis::kUpdates;
  if (word == "wall") return PlotAxis::kWallMinutes;
  throw UsageError("axis '{}': expected env-steps | frames | updates | wall", word);
}

PlotFigure ParsePlotFigure(const std::string& word) {
  if (word == "success") return PlotFigure::kSuccess;
  if (word == "return") return PlotFigure::kReturn;
  if (word == "distance") return PlotFigure::kFinalDistance;
  throw UsageError("figure '{}': expected success | return | distance", word);
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
  std::vector<std::vector<Drawn>> drawn(panels, std::vector<Drawn>(groups.size()));
  for (size_t f = 0; f < panels; ++f) {
    bool any = false;
    for (size_t g = 0; g < groups.size(); ++g) {
      const auto curve = CurveOf(groups[g], plot.axis, plot.figures[f]);
      const auto rollouts = RolloutCurveOf(groups[g], plot.axis, plot.figures[f]);
      drawn[f][g] = {.evaluations = !curve.empty(), .rollouts = !rollouts.empty()};
      any |= drawn[f][g].evaluations;
      if (!curve.empty()) script += DataBlock(BlockName(g, f), curve);
      if (!rollouts.empty()) script += DataBlock(RolloutBlockName(g, f), rollouts);
    }
    if (!any) {
      throw UsageError("no run has evaluations with {} to draw", FigureLabel(plot.figures[f]));
    }
  }
  const std::vector<ReferenceCurve> published =
      ReferenceCurvesOf(plot.references, groups, plot.axis);
  for (size_t i = 0; i < published.size(); ++i) {
    script += ReferenceBlock(ReferenceBlockName(i), published[i]);
  }
  script += fmt::format(
      "set border 3 lc rgb '#666666'\nset tics nomirror out textcolor rgb '#333333'\n"
      "set grid lc rgb '#dddddd' lt 1\nset xrange [0:*]\nset autoscale xfixmax\nset format x "
      "'%.10g'\nset "
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
    const bool returns = plot.figures[f] == PlotFigure::kReturn;
    script += PanelCommands(groups, f, drawn[f], f == 0,
                            returns ? ReferenceElements(published) : std::vector<std::string>());
  }
  return script + "unset multiplot\n";
}

void Draw(const Plot& plot, const std::vector<RunGroup>& groups, const fs::path& output) {
  CheckWritable(output);
  const ScratchFolder scratch;
  // Draw the picture in another file, then move it, so that a reader gets either the old or the new
  // picture.
  const fs::path script = scratch.path() / "plot.gp",
                 drawn = scratch.path() / ("plot" + output.extension().string());
  WriteFileAtomically(script, PlotScript(plot, groups, drawn));
  if (!FindOnSearchPath("gnuplot")) {
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
