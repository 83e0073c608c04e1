// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/launch/tools/experiment/planted_run.h"

namespace shoal::launch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

RunPlanter Plant(const std::filesystem::path& folder) {
  const RunPlanter planter(folder);
  planter.Begin();
  planter.WriteEvaluation(100, 0.5);
  planter.WriteEvaluation(200, 0.95);
  planter.WriteEvaluation(300, 0.95);
  planter.WriteFinal(1, 100);
  planter.WriteMeta("budget");
  return planter;
}

TEST(Report, IsOnePageThatNeedsNothingElse) {
  const TemporaryFolder folder;
  Plant(folder.path() / "a");
  MakeFolders(folder.path() / "a/videos");
  std::ofstream(folder.path() / "a/videos/film.mp4") << "Man";
  const std::string html =
      ReportHtml(GatherReport({.names = {"a"}, .run_dir = folder.path().string()}));
  for (const char* part :
       {"100.0 % [96.3, 100.0] (100/100)", ">env steps<", ">wall time, minutes<",
        "&quot;batch&quot;: ", "abc, def", "a fast one (2 cores)", "<td>712</td><td>1.23</td>",
        "/config.json --run-name a-again --set run_dir=runs", "data:video/mp4;base64,TWFu"}) {
    EXPECT_THAT(html, HasSubstr(part));
  }
  for (const char* link : {"<script", "src=\"http", "<link", "url("}) {
    EXPECT_THAT(html, Not(HasSubstr(link)));
  }
}

TEST(Report, ShowsTheEpisodesOfTheActors) {
  const TemporaryFolder folder;
  Plant(folder.path() / "a");
  const auto page = [&] {
    return ReportHtml(GatherReport({.names = {"a"}, .run_dir = folder.path().string()}));
  };
  EXPECT_THAT(page(), Not(HasSubstr("episodes of the actors")));
  WriteFileAtomically(folder.path() / "a/metrics.jsonl",
                      R"({"role":"coordinator","env_steps":50,"rollout_success":0.25})"
                      "\n");
  EXPECT_THAT(page(), HasSubstr("episodes of the actors"));
}

TEST(Report, OfATaskWithoutSuccessItSaysNothingAboutIt) {
  const TemporaryFolder folder;
  const RunPlanter run = Plant(folder.path() / "a");
  const auto page = [&] {
    return ReportHtml(GatherReport({.names = {"a"}, .run_dir = folder.path().string()}));
  };
  EXPECT_THAT(page(),
              AllOf(HasSubstr("<th>success"), HasSubstr("<th>env steps (wall clock) to 90 %")));
  run.WriteFinal(std::nullopt, 100);
  EXPECT_THAT(page(), AllOf(HasSubstr("<th>return"), Not(HasSubstr("<th>success")),
                            Not(HasSubstr("<th>env steps (wall"))));
}

TEST(Report, ShowsTheDefinitionOfAnExperiment) {
  const TemporaryFolder folder;
  Definition definition{.name = "mine", .base = "fetch-reach-state", .question = "Why?"};
  definition.set = {{"env_steps", 1000}};
  definition.arms = {{"x", nlohmann::ordered_json::object()}, {"y", {{"learner.batch", 32}}}};
  definition.seeds = {4, 7};
  definition.final_episodes = 60;
  const ExperimentFolder open(PlanExperiment(folder.path() / "mine", definition, "x.json"));
  for (const ExperimentRun& run : open.experiment().Runs()) Plant(run.folder);
  const std::string html = ReportHtml(
      GatherReport({.names = {"mine"}, .run_dir = "nowhere", .experiment_dir = folder.path()}));
  for (const char* part : {"<h1>mine</h1>", "Why?", "<td>arm y</td><td>learner.batch = 32</td>",
                           "<td>4, 7</td>", "<td>60</td>", "<td>env_steps = 1000</td>",
                           "fetch-reach-state", "shoal experiment run mine"}) {
    EXPECT_THAT(html, HasSubstr(part));
  }
}

// An experiment with two tasks.
class ReportOfTasks : public testing::Test {
 protected:
  std::string Page(const Definition& changes, const std::vector<Reference>& references = {}) const {
    Definition definition{.name = "mine", .base = "cartpole-swingup-state"};
    definition.arms = {{"cartpole", nlohmann::ordered_json::object()},
                       {"walker", {{"task", "walker_walk"}}}};
    definition.seeds = {0};
    definition.frames = changes.frames;
    definition.reference = changes.reference;
    const ExperimentFolder open(PlanExperiment(folder_.path() / "mine", definition, "x.json"));
    for (const ExperimentRun& run : open.experiment().Runs()) {
      const RunPlanter planter(run.folder);
      planter.Begin({run.arm == 1 ? "task=walker_walk" : "task=cartpole_swingup"});
      planter.WriteEvaluation(6'000, 0.5, 300);
      planter.WriteEvaluation(run.arm == 1 ? 50'000 : 12'500, 0.5, 700);
      planter.WriteMeta("interrupted");
    }
    return ReportHtml(GatherReport(
        {.names = {"mine"}, .run_dir = "nowhere", .experiment_dir = folder_.path()}, references));
  }
  static int Count(const std::string& html, const std::string& part) {
    int count = 0;
    for (size_t at = html.find(part); at != std::string::npos; at = html.find(part, at + 1)) {
      ++count;
    }
    return count;
  }

  const TemporaryFolder folder_;
};

TEST_F(ReportOfTasks, HasAChartForEachTask) {
  const std::string html = Page({});
  EXPECT_EQ(Count(html, "<svg"), 4) << "two tasks, two axes";
  EXPECT_EQ(Count(html, ">cartpole_swingup</"), 2);
  EXPECT_EQ(Count(html, ">walker_walk</"), 2);
  EXPECT_EQ(Count(html, ">env steps</tspan>"), 2);
  EXPECT_THAT(html, HasSubstr(">cartpole_swingup, walker_walk &middot; written"));
  EXPECT_THAT(html, Not(HasSubstr("environment frames")));
}

TEST_F(ReportOfTasks, WithFramesHasTheirAxisTheirTableAndTheReference) {
  Definition changes;
  changes.frames = {100'000};
  changes.reference = "planet-6";
  const std::string html = Page(changes);
  EXPECT_EQ(Count(html, ">environment frames (env steps x action repeat)<"), 2);
  EXPECT_THAT(html, Not(HasSubstr(">env steps</tspan>")));
  for (const char* part : {"<h2>Returns at environment frames</h2>", "<th>100000 [95 %]</th>",
                           "<td>mean of 2 tasks</td><td>700.0 (1 seed)</td>", "<th>DrQ K=M=1</th>",
                           "<td>759</td>", "Dashed lines: reference planet-6.", "arXiv:2004.13649",
                           ">SAC pixels: Laskin", "<td>returns at frames</td><td>100000</td>"}) {
    EXPECT_THAT(html, HasSubstr(part));
  }
  EXPECT_EQ(Count(html, ">DrQ</text>"), 2) << "in both charts over frames";
}

TEST_F(ReportOfTasks, DrawsReferencesOfTheCommand) {
  const Reference own{
      .name = "own",
      .source = "s",
      .results = {{.method = "Theirs", .task = "walker_walk", .frames = {100}, .returns = {5}}}};
  EXPECT_THAT(Page({}), Not(HasSubstr("Theirs")));
  EXPECT_THAT(Page({}, {own}), AllOf(HasSubstr(">Theirs<"), HasSubstr(">Dashed lines: reference "
                                                                      "own. s</p>")));
}

TEST(Report, SaysWhyAReferenceIsMissing) {
  ReportContent content{.title = "t", .curves = {"<svg></svg>"}};
  content.problems = {"The reference is not shown: <x>."};
  EXPECT_THAT(ReportHtml(content), HasSubstr("The reference is not shown: &lt;x&gt;."));
}

TEST(Report, WhatComesFromOutsideIsEscaped) {
  ReportContent content{.title = "<b>", .question = "a & \"b\""};
  content.comparison.groups.push_back({.name = "<script>x</script>"});
  const std::string html = ReportHtml(content);
  EXPECT_THAT(html, Not(HasSubstr("<script>")));
  EXPECT_THAT(html, HasSubstr("&lt;script&gt;"));
  EXPECT_THAT(html, HasSubstr("a &amp; &quot;b&quot;"));
}

TEST(Report, NamesWhatIsMissing) {
  ReportContent content{.title = "t"};
  content.comparison.groups.push_back({.name = "a", .unevaluated = {"a-s3"}});
  EXPECT_THAT(ReportHtml(content), HasSubstr("Missing: a-s3."));
}

}  // namespace
}  // namespace shoal::launch
