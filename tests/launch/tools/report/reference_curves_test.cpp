// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/report/reference_curves.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "launch/tools/report/plot.h"

namespace shoal::launch {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

RunGroup GroupOn(const std::string& task, int64_t budget, uint64_t last_evaluation) {
  RunResults run;
  run.config.task = task;
  run.config.env_steps = budget;
  run.curve = {{.env_steps = 10, .success = 0.5, .return_mean = 1},
               {.env_steps = last_evaluation, .success = 0.5, .return_mean = 2}};
  return {.name = "own " + task, .runs = {run}};
}

Reference Published() {
  return {.name = "r",
          .source = "s",
          .results = {{.method = "DrQ",
                       .task = "cartpole_swingup",
                       .frames = {100'000, 500'000},
                       .returns = {759, 868}},
                      {.method = "DrQ",
                       .task = "walker_walk",
                       .frames = {100'000, 500'000},
                       .returns = {612, 921}},
                      {.method = "Other", .task = "hopper", .frames = {1}, .returns = {1}}}};
}

TEST(ReferenceCurves, AreThoseOfTheTasksAlongEnvSteps) {
  const auto curves = ReferenceCurvesOf({Published()}, {GroupOn("cartpole_swingup", 62'500, 100)},
                                        PlotAxis::kEnvSteps);
  ASSERT_EQ(curves.size(), 1u);
  EXPECT_EQ(curves[0].title, "DrQ");
  EXPECT_FALSE(curves[0].group) << "grey: there is one task";
  ASSERT_EQ(curves[0].points.size(), 2u);
  EXPECT_EQ(curves[0].points[0].x, 12'500) << "8 frames are one env step";
  EXPECT_EQ(curves[0].points[0].value, 759);
  EXPECT_EQ(curves[0].points[1].x, 62'500);
}

TEST(ReferenceCurves, EndWithTheRuns) {
  const auto points_of = [](int64_t budget, uint64_t last) {
    const auto curves =
        ReferenceCurvesOf({Published()}, {GroupOn("walker_walk", budget, last)}, PlotAxis::kFrames);
    return curves.empty() ? size_t{0} : curves[0].points.size();
  };
  EXPECT_EQ(points_of(50'000, 100), 1u) << "the budget is 100,000 frames";
  EXPECT_EQ(points_of(100, 50'000), 1u) << "the last evaluation is later";
  EXPECT_EQ(points_of(49'100, 100), 1u) << "within 2 %";
  EXPECT_EQ(points_of(49'000, 100), 0u);
}

TEST(ReferenceCurves, OfSeveralTasksHaveTheColoursOfTheGroups) {
  const auto curves = ReferenceCurvesOf(
      {Published()},
      {GroupOn("walker_walk", 50'000, 100), GroupOn("cartpole_swingup", 12'500, 100)},
      PlotAxis::kFrames);
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_EQ(curves[0].title, "DrQ, cartpole_swingup");
  EXPECT_EQ(curves[0].group, 1u);
  EXPECT_EQ(curves[1].group, 0u);
  EXPECT_EQ(curves[1].points[0].x, 100'000);
}

TEST(ReferenceCurves, AreNotDrawnWhereTheyHaveNoPlace) {
  const std::vector<RunGroup> one{GroupOn("walker_walk", 50'000, 100)};
  EXPECT_THAT(ReferenceCurvesOf({Published()}, one, PlotAxis::kUpdates), IsEmpty());
  EXPECT_THAT(ReferenceCurvesOf({Published()}, one, PlotAxis::kWallMinutes), IsEmpty());
  EXPECT_THAT(
      ReferenceCurvesOf({Published()}, {GroupOn("cheetah_run", 50'000, 100)}, PlotAxis::kFrames),
      IsEmpty());
  RunGroup four = GroupOn("walker_walk", 25'000, 100);
  four.runs[0].config.action_repeat = 4;
  EXPECT_THAT(ReferenceCurvesOf({Published()}, {one[0], four}, PlotAxis::kEnvSteps), IsEmpty())
      << "an env step has 2 frames in one group and 4 in the other";
  EXPECT_EQ(ReferenceCurvesOf({Published()}, {one[0], four}, PlotAxis::kFrames).size(), 1u);
}

TEST(PlotScript, DrawsReferencesAsDashedLinesAmongTheReturns) {
  const Plot plot{.title = "t",
                  .axis = PlotAxis::kFrames,
                  .figures = {PlotFigure::kSuccess, PlotFigure::kReturn},
                  .references = {Published()}};
  const std::string script = PlotScript(plot, {GroupOn("walker_walk", 250'000, 50'000)}, "x.svg");
  EXPECT_THAT(script, HasSubstr("$reference_0 << EOD\n100000 612\n500000 921\nEOD\n"));
  EXPECT_THAT(script, HasSubstr("set xlabel 'environment frames (env steps x action repeat)'"));
  const std::string line =
      "$reference_0 using 1:2 with linespoints dt 2 lw 1 pt 4 ps 0.8 lc rgb '#666666' title 'DrQ'";
  const size_t returns = script.find("set ylabel 'mean return'");
  ASSERT_NE(returns, std::string::npos);
  EXPECT_THAT(script.substr(0, returns), Not(HasSubstr("$reference_0 using")));
  EXPECT_THAT(script.substr(returns), HasSubstr(line));
}

TEST(ReferenceCurves, NumberTheMethods) {
  Reference reference = Published();
  reference.results.insert(
      reference.results.begin(),
      {.method = "CURL", .task = "walker_walk", .frames = {100'000}, .returns = {344}});
  const auto curves = ReferenceCurvesOf(
      {reference}, {GroupOn("walker_walk", 50'000, 100), GroupOn("cartpole_swingup", 12'500, 100)},
      PlotAxis::kFrames);
  ASSERT_EQ(curves.size(), 3u);
  EXPECT_EQ(curves[0].method, 0u);
  EXPECT_EQ(curves[1].method, 1u);
  EXPECT_EQ(curves[2].method, 1u) << "the same method on another task";
}

TEST(PlotScript, ColoursReferencesLikeTheGroupOfTheirTask) {
  const Plot plot{.title = "t", .figures = {PlotFigure::kReturn}, .references = {Published()}};
  const std::string script = PlotScript(
      plot, {GroupOn("walker_walk", 250'000, 50'000), GroupOn("cartpole_swingup", 62'500, 50'000)},
      "x.svg");
  EXPECT_THAT(script, HasSubstr("lc rgb '#D55E00' title 'DrQ, cartpole_swingup'"));
  EXPECT_THAT(script, HasSubstr("pt 4 ps 0.8 lc rgb '#0072B2' title 'DrQ, walker_walk'"));
}

}  // namespace
}  // namespace shoal::launch
