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
        "&quot;batch&quot;: ", "abc, def", "a fast one (2 cores)",
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
