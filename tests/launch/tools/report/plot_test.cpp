// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/report/plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

RunResults RunOf(const std::vector<std::pair<uint64_t, double>>& returns,
                 std::optional<double> success = std::nullopt) {
  RunResults run;
  for (const auto& [env_steps, value] : returns) {
    run.curve.push_back({.env_steps = env_steps,
                         .updates = env_steps / 2,
                         .wall_seconds = static_cast<double>(env_steps) * 60,
                         .success = success,
                         .return_mean = value});
  }
  return run;
}

RunGroup TwoSeeds() {
  return {.name = "a \"b\"", .runs = {RunOf({{100, 0}, {200, 10}}), RunOf({{100, 4}, {300, 8}})}};
}

TEST(CurveOf, TakesTheSeedsThatReachToThePoint) {
  const auto curve = CurveOf(TwoSeeds(), PlotAxis::kEnvSteps, PlotFigure::kReturn);
  ASSERT_EQ(curve.size(), 3u);
  EXPECT_EQ(curve[0].mean, 2);
  EXPECT_EQ(curve[0].low, 0);
  EXPECT_EQ(curve[0].high, 4);
  // At 200 the second seed is halfway between 4 and 8.
  EXPECT_EQ(curve[1].x, 200);
  EXPECT_EQ(curve[1].mean, 8);
  EXPECT_EQ(curve[1].low, 6);
  EXPECT_EQ(curve[1].high, 10);
  EXPECT_EQ(curve[2].seeds, 1u) << "the first seed ended at 200: nothing is made up beyond";
  EXPECT_EQ(curve[2].mean, 8);
}

TEST(CurveOf, GoesAlongTheAxisAskedFor) {
  EXPECT_EQ(CurveOf(TwoSeeds(), PlotAxis::kUpdates, PlotFigure::kReturn)[0].x, 50);
  EXPECT_EQ(CurveOf(TwoSeeds(), PlotAxis::kWallMinutes, PlotFigure::kReturn)[0].x, 100);
  EXPECT_TRUE(CurveOf(TwoSeeds(), PlotAxis::kEnvSteps, PlotFigure::kSuccess).empty());
}

TEST(CurveOf, CountsTheFramesOfEachRun) {
  RunGroup group = TwoSeeds();
  group.runs[0].config.task = "cartpole_swingup";  // 8 control steps
  group.runs[1].config.action_repeat = 3;
  const auto curve = CurveOf(group, PlotAxis::kFrames, PlotFigure::kReturn);
  ASSERT_EQ(curve.size(), 4u);
  EXPECT_EQ(curve[0].x, 300);
  EXPECT_EQ(curve[1].x, 800);
  EXPECT_EQ(curve[3].x, 1600);
}

TEST(ParsePlotAxis, HasAWordForEach) {
  EXPECT_EQ(ParsePlotAxis("env-steps"), PlotAxis::kEnvSteps);
  EXPECT_EQ(ParsePlotAxis("frames"), PlotAxis::kFrames);
  EXPECT_EQ(ParsePlotAxis("updates"), PlotAxis::kUpdates);
  EXPECT_EQ(ParsePlotAxis("wall"), PlotAxis::kWallMinutes);
}

TEST(CurveOf, ThinsButKeepsTheEnd) {
  std::vector<std::pair<uint64_t, double>> many;
  for (uint64_t i = 1; i <= 1000; ++i) many.emplace_back(i, 1.0);
  const auto curve =
      CurveOf({.name = "a", .runs = {RunOf(many)}}, PlotAxis::kEnvSteps, PlotFigure::kReturn, 100);
  EXPECT_LE(curve.size(), 101u);
  EXPECT_EQ(curve.back().x, 1000);
}

RunResults WithRollouts(RunResults run) {
  run.rollouts = {{.env_steps = 10, .updates = 5, .wall_seconds = 60, .success = 0.25},
                  {.env_steps = 20, .updates = 9, .wall_seconds = 120, .success = 0.75}};
  return run;
}

TEST(RolloutCurveOf, IsThatOfTheActorsEpisodes) {
  const RunGroup group{.name = "a", .runs = {WithRollouts(RunOf({{100, 0}}, 1.0))}};
  const auto curve = RolloutCurveOf(group, PlotAxis::kWallMinutes, PlotFigure::kSuccess);
  ASSERT_EQ(curve.size(), 2u);
  EXPECT_EQ(curve[0].x, 1);
  EXPECT_EQ(curve[0].mean, 25);
  EXPECT_EQ(curve[1].mean, 75);
  EXPECT_EQ(RolloutCurveOf(group, PlotAxis::kFrames, PlotFigure::kSuccess)[0].x, 10);
  EXPECT_TRUE(RolloutCurveOf(group, PlotAxis::kEnvSteps, PlotFigure::kReturn).empty())
      << "files of older builds have no return";
  EXPECT_TRUE(RolloutCurveOf(TwoSeeds(), PlotAxis::kEnvSteps, PlotFigure::kSuccess).empty());
}

TEST(PlotScript, DrawsTheActorsEpisodesAsThinLines) {
  const Plot plot{.title = "t", .figures = {PlotFigure::kSuccess}};
  const RunResults run = RunOf({{100, 0}, {200, 10}}, 0.5);
  EXPECT_THAT(PlotScript(plot, {{.name = "a", .runs = {run}}}, "x.svg"), Not(HasSubstr("thin")));
  const std::string script =
      PlotScript(plot, {{.name = "a", .runs = {WithRollouts(run)}}}, "x.svg");
  EXPECT_THAT(script, HasSubstr("$rollouts_0_0 << EOD\n10 25 25 25\n20 75 75 75\nEOD\n"));
  EXPECT_THAT(script, HasSubstr("$rollouts_0_0 using 1:2 with lines lw 1"));
  EXPECT_THAT(script, HasSubstr("title 'thin: episodes of the actors'"));
  EXPECT_THAT(script, HasSubstr("set xrange [0:*]"));
}

TEST(PlotScript, SaysWhatCannotBeDrawn) {
  const Plot plot{.title = "t", .figures = {PlotFigure::kSuccess}};
  EXPECT_THROW(PlotScript(plot, {TwoSeeds()}, "x.png"), Error);
  EXPECT_THROW(PlotScript({.title = "t", .figures = {PlotFigure::kReturn}}, {TwoSeeds()}, "x.gif"),
               Error);
  EXPECT_THROW(ParsePlotAxis("time"), Error);
  EXPECT_THROW(ParsePlotFigure("loss"), Error);
}

TEST(PlotScript, NamesCannotEndAString) {
  const std::string script = PlotScript(
      {.title = "it's \"high\"\n", .figures = {PlotFigure::kReturn}}, {TwoSeeds()}, "x.png");
  EXPECT_THAT(script, HasSubstr(R"x(title 'a "b" (2 seeds)')x"));
  EXPECT_THAT(script, HasSubstr(R"x(title 'it''s "high" ')x"));
  EXPECT_THAT(script, HasSubstr("filledcurves"));
  const RunGroup one{.name = "one", .runs = {RunOf({{100, 0}, {200, 10}})}};
  EXPECT_THAT(PlotScript({.title = "t", .figures = {PlotFigure::kReturn}}, {one}, "x.svg"),
              Not(HasSubstr("filledcurves")))
      << "one seed has no band";
}

TEST(Draw, ANameRunsNoCommand) {
  const TemporaryFolder folder;
  const std::string mark = (folder.path() / "mark").string();
  const std::string name = fmt::format("x`touch {0}`'.system('touch {0}').\"$(touch {0})", mark);
  RunGroup group = TwoSeeds();
  group.name = name;
  Draw({.title = name, .figures = {PlotFigure::kReturn}}, {group}, folder.path() / "x.svg");
  EXPECT_FALSE(std::filesystem::exists(mark));
  EXPECT_THAT(ReadFile(folder.path() / "x.svg"), HasSubstr("x`touch"));
}

TEST(Draw, MakesPicturesOfBothKinds) {
  const TemporaryFolder folder;
  const RunGroup group{
      .name = "a", .runs = {RunOf({{100, 0}, {200, 10}}, 0.5), RunOf({{100, 4}, {300, 8}}, 0.7)}};
  const Plot plot{.title = "t", .figures = FiguresThereAre({group})};
  ASSERT_EQ(plot.figures.size(), 2u);
  Draw(plot, {group}, folder.path() / "x.png");
  Draw(plot, {group}, folder.path() / "x.svg");
  EXPECT_THAT(ReadFile(folder.path() / "x.png"), StartsWith("\x89PNG"));
  EXPECT_GT(ReadFile(folder.path() / "x.png").size(), 5000u) << "curves, not an empty sheet";
  EXPECT_THAT(ReadFile(folder.path() / "x.svg"), HasSubstr("<svg"));
}

TEST(Draw, AMissingGnuplotIsOneLineThatSaysWhatToInstall) {
  const TemporaryFolder folder;
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  try {
    Draw({.title = "t", .figures = {PlotFigure::kReturn}}, {TwoSeeds()}, folder.path() / "x.png");
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("gnuplot-nox"));
  }
  setenv("PATH", path.c_str(), 1);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "x.png"));
}

}  // namespace
}  // namespace shoal::launch
