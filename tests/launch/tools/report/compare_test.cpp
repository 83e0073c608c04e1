// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/report/compare.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "launch/tools/experiment/experiment_folder.h"
#include "tests/launch/tools/experiment/planted_run.h"
#include "tests/support/error_message.h"

namespace shoal::launch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class CompareTest : public testing::Test {
 protected:
  // A finished run RUNS/NAME that reached 90 % at `n` env steps.
  RunPlanter Plant(const std::string& name, int64_t seed, uint64_t n, double success,
                   const std::vector<std::string>& keys = {}) const {
    const RunPlanter planter(runs_ / name);
    std::vector<std::string> all = keys;
    all.push_back("seed=" + std::to_string(seed));
    planter.Begin(all);
    planter.WriteEvaluation(n / 2, 0.3);
    planter.WriteEvaluation(n, 0.95);
    planter.WriteEvaluation(n + 100, 1);
    planter.WriteFinal(success, 100);
    planter.WriteMeta("budget");
    return planter;
  }
  std::vector<RunGroup> Read(const std::vector<std::string>& names) const {
    return SubjectsOf(names).groups;
  }
  Subjects SubjectsOf(const std::vector<std::string>& names) const {
    return ReadSubjects({.names = names,
                         .run_dir = runs_.string(),
                         .experiment_dir = (folder_.path() / "experiments").string()});
  }
  std::string Refusal(const std::vector<std::string>& names) const {
    return UsageMessage([&] { Compare(Read(names), 0.9); });
  }

  const TemporaryFolder folder_;
  const std::filesystem::path runs_ = folder_.path() / "runs";
};

TEST_F(CompareTest, RunsAreGroupsOfOneSeed) {
  Plant("a", 1, 200, 1);
  Plant("b", 1, 400, 0.5, {"learner.batch=64"});
  const Comparison comparison = Compare(Read({"a", (runs_ / "b").string() + "/"}), 0.9);
  ASSERT_EQ(comparison.groups.size(), 2u);
  EXPECT_EQ(comparison.task, "FetchReachDense");
  EXPECT_EQ(comparison.groups[1].name, "b");
  EXPECT_EQ(comparison.groups[1].figures.Successes(), 50u);
  EXPECT_EQ(comparison.groups[1].figures.Episodes(), 100u);
  EXPECT_THAT(comparison.groups[1].n_to_target, ElementsAre(400.0));
  EXPECT_THAT(comparison.groups[1].seconds_to_target, ElementsAre(4.0));
  EXPECT_THAT(ToText(comparison), HasSubstr("b: 400 (4 s)"));
  EXPECT_EQ(comparison.ratios[0].median, 2);
  ASSERT_EQ(comparison.differences.size(), 1u) << "not the names of the runs";
  EXPECT_EQ(comparison.differences[0].key, "learner.batch");
  EXPECT_THAT(comparison.differences[0].values, ElementsAre("128", "64"));
  // 360 s on 2 cores.
  EXPECT_DOUBLE_EQ(comparison.groups[0].core_hours, 0.2);
}

TEST_F(CompareTest, ARatioPairsEqualSeedsAlone) {
  Plant("a", 1, 200, 1);
  Plant("b", 2, 400, 1);
  const Comparison comparison = Compare(Read({"a", "b"}), 0.9);
  EXPECT_TRUE(comparison.ratios[0].pairs.empty());
  EXPECT_EQ(comparison.ratios[0].median, std::nullopt);
}

TEST_F(CompareTest, ARatioIsOfFinishedRuns) {
  Plant("a", 1, 200, 1);
  const RunPlanter planter = Plant("b", 1, 400, 1);
  planter.WriteMeta("interrupted");
  std::filesystem::remove(runs_ / "b/eval/steps_0000000400.json");
  Comparison comparison = Compare(Read({"a", "b"}), 0.9);
  EXPECT_TRUE(comparison.ratios[0].pairs.empty()) << "it may still get there";
  EXPECT_EQ(comparison.ratios[0].not_reached, 0);
  EXPECT_THAT(ToText(comparison), HasSubstr("b: not yet"));
  planter.WriteMeta("budget");
  comparison = Compare(Read({"a", "b"}), 0.9);
  EXPECT_EQ(comparison.ratios[0].not_reached, 1);
  EXPECT_THAT(ToText(comparison), HasSubstr("b: not reached"));
}

TEST_F(CompareTest, ARunIsFoundByNameBeforeAFolderOfThatNameHere) {
  Plant("a", 1, 200, 1);
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder_.path());
  RunPlanter("a").Begin();  // without an evaluation: it would be refused
  const Subjects subjects = SubjectsOf({"a"});
  std::filesystem::current_path(before);
  EXPECT_EQ(subjects.named[0].name, "a");
  EXPECT_FALSE(subjects.named[0].experiment);
  EXPECT_EQ(subjects.groups[0].runs[0].folder, runs_ / "a");
}

TEST_F(CompareTest, AnArmIsAGroupAndWhatIsMissingIsNamed) {
  Definition definition{.name = "mine", .base = "fetch-reach-state"};
  definition.arms = {{"x", nlohmann::ordered_json::object()}, {"y", {{"learner.batch", 32}}}};
  definition.seeds = {0, 1};
  const ExperimentFolder open(
      PlanExperiment(folder_.path() / "experiments/mine", definition, "x.json"));
  for (const ExperimentRun& run : open.experiment().Runs({0, 1})) {
    if (run.name == "y-s1") continue;
    const RunPlanter planter(run.folder);
    planter.Begin({"seed=" + std::to_string(run.seed)});
    planter.WriteEvaluation(100, 1);
    planter.WriteEvaluation(200, 1);
    planter.WriteMeta("budget");
    if (run.name != "x-s1") planter.WriteFinal(1, 10);
  }
  const Comparison comparison = Compare(Read({"mine"}), 0.9);
  ASSERT_EQ(comparison.groups.size(), 2u);
  EXPECT_EQ(comparison.groups[0].name, "x");
  EXPECT_THAT(comparison.groups[0].over, ElementsAre(true, false));
  EXPECT_THAT(comparison.groups[0].seeds, ElementsAre(0, 1));
  EXPECT_THAT(comparison.groups[0].without_final, ElementsAre("x-s1"));
  EXPECT_THAT(comparison.groups[1].unevaluated, ElementsAre("y-s1"));
  const std::string text = ToText(comparison);
  EXPECT_THAT(text, HasSubstr("y-s1"));
  EXPECT_THAT(text, HasSubstr("x-s1"));
  Plant("a", 1, 200, 1);
  EXPECT_EQ(Read({"mine", "a"})[0].name, "mine/x") << "several subjects: in full";
}

TEST_F(CompareTest, AFailedSeedIsCountedInTheRowOfItsArm) {
  Definition definition{.name = "mine", .base = "fetch-reach-state"};
  definition.arms = {{"x", nlohmann::ordered_json::object()}, {"y", {{"learner.batch", 32}}}};
  definition.seeds = {0, 1};
  const ExperimentFolder open(
      PlanExperiment(folder_.path() / "experiments/mine", definition, "x.json"));
  for (const ExperimentRun& run : open.experiment().Runs({0, 1})) {
    const RunPlanter planter(run.folder);
    planter.Begin({"seed=" + std::to_string(run.seed)});
    const bool failed = run.name == "y-s1";
    planter.WriteEvaluation(100, failed ? 0.1 : 1);
    planter.WriteEvaluation(200, failed ? 0.1 : 1);
    planter.WriteFinal(failed ? 0.1 : 1, 10);  // of the best checkpoint that it had
    planter.WriteMeta(failed ? "failed" : "budget", failed ? "critic_loss is nan" : "");
  }
  const Comparison comparison = Compare(Read({"mine"}), 0.9);
  const GroupFigures& y = comparison.groups[1];
  EXPECT_THAT(y.failed, ElementsAre("y-s1"));
  EXPECT_EQ(y.figures.returns.size(), 1u);
  EXPECT_EQ(comparison.ratios[0].not_reached, 1) << "it will not get there any more";
  const std::string text = ToText(comparison);
  EXPECT_THAT(text, HasSubstr("1, 1 failed  100.0 % [72.2, 100.0] (10/10; 1 failed: 50.0 % with it "
                              "as 0)"));
  EXPECT_THAT(text, HasSubstr("failed: y-s1\n"));
  EXPECT_EQ(ToJson(comparison).at("groups").at(1).at("success").at("failed"), 1);
  // A failed run alone has no other figures to show.
  const Comparison alone =
      Compare(Read({(folder_.path() / "experiments/mine/runs/y-s1").string()}), 0.9);
  EXPECT_THAT(ToText(alone), HasSubstr("1, failed  10.0 % "));
}

TEST_F(CompareTest, FourSeedsHaveAnInterquartileMean) {
  Definition definition{.name = "mine", .base = "fetch-reach-state"};
  definition.arms = {{"x", nlohmann::ordered_json::object()}};
  definition.seeds = {0, 1, 2, 3};
  const ExperimentFolder open(
      PlanExperiment(folder_.path() / "experiments/mine", definition, "x.json"));
  const std::vector<double> rates{0.1, 0.9, 0.8, 1.0};
  for (const ExperimentRun& run : open.experiment().Runs({0, 1, 2, 3})) {
    const RunPlanter planter(run.folder);
    planter.Begin({"seed=" + std::to_string(run.seed)});
    planter.WriteFinal(rates[static_cast<size_t>(run.seed)], 10);
    planter.WriteMeta("budget");
  }
  const Comparison comparison = Compare(Read({"mine"}), 0.9);
  const auto success = ToJson(comparison).at("groups").at(0).at("success");
  EXPECT_NEAR(success.at("iqm").get<double>(), 0.85, 1e-12) << "the mean is 0.7";
  EXPECT_EQ(success.at("iqm95").size(), 2u);
  EXPECT_THAT(ToText(comparison),
              HasSubstr("interquartile mean over seeds [95 %, stratified bootstrap]:\n"
                        "  x: success 85.0 % ["));
}

TEST_F(CompareTest, WhatDoesNotCompareIsRefusedByName) {
  Plant("a", 1, 200, 1);
  Plant("push", 1, 200, 1, {"task=FetchPush"});
  EXPECT_THAT(Refusal({"a", "push"}), HasSubstr("FetchPush"));
  EXPECT_THAT(Refusal({"a", "a"}), HasSubstr("twice"));
  EXPECT_THAT(Refusal({"nothing"}), HasSubstr("nothing"));
  RunPlanter(runs_ / "empty").Begin();
  EXPECT_THAT(Refusal({"empty"}), HasSubstr("no evaluations"));
}

TEST_F(CompareTest, JsonHasWhatTheTextSays) {
  Plant("a", 1, 200, 1);
  Plant("b", 1, 400, 0.5);
  const auto json = ToJson(Compare(Read({"a", "b"}), 0.9));
  EXPECT_EQ(json.at("schema"), "shoal-comparison-1");
  EXPECT_EQ(json.at("groups").at(1).at("success").at("pooled"), 0.5);
  EXPECT_EQ(json.at("groups").at(1).at("return").at("seeds"), 1);
  EXPECT_EQ(json.at("ratios").at(0).at("name"), "b/a");
  EXPECT_EQ(json.at("ratios").at(0).at("pairs").at(0).at("ratio"), 2.0);
  EXPECT_TRUE(json.at("differences").empty());
}

}  // namespace
}  // namespace shoal::launch
