// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/experiment/experiment_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

Definition TwoArms() {
  Definition definition{.name = "mine", .base = "fetch-reach-state"};
  definition.arms = {{"a", {{"learner.batch", 64}}}, {"b", nlohmann::ordered_json::object()}};
  definition.seeds = {3, 1};
  return definition;
}

class ExperimentFolderTest : public testing::Test {
 protected:
  ExperimentPlan Plan(const Definition& definition) const {
    return PlanExperiment(path_, definition, "x.json");
  }
  // The error of opening; empty if there is none.
  std::string Refusal(const Definition& definition) const {
    return UsageMessage([&] { const ExperimentFolder open(Plan(definition)); });
  }

  const TemporaryFolder folder_;
  const fs::path path_ = folder_.path() / "experiment";
};

TEST_F(ExperimentFolderTest, RunsAreArmsTimesSeedsSeedBySeed) {
  const ExperimentFolder open(Plan(TwoArms()));
  std::vector<std::string> names;
  for (const auto& run : open.experiment().Runs({3, 1})) names.push_back(run.name);
  EXPECT_THAT(names, testing::ElementsAre("a-s3", "b-s3", "a-s1", "b-s1"));
}

TEST_F(ExperimentFolderTest, TheBaseOfTheFirstRunHolds) {
  { const ExperimentFolder first(Plan(TwoArms())); }
  // Stands for a preset that has changed since.
  auto object = nlohmann::ordered_json::parse(ReadFile(path_ / "experiment.json"));
  object["base"]["learner"]["discount"] = 0.123;
  WriteFileAtomically(path_ / "experiment.json", object.dump());
  const ExperimentFolder second(Plan(TwoArms()));
  EXPECT_EQ(second.experiment().base.learner.discount, 0.123);
  EXPECT_EQ(ReadExperiment(path_).base.learner.discount, 0.123);
}

TEST_F(ExperimentFolderTest, FurtherArmsAndSeedsAreTaken) {
  { const ExperimentFolder first(Plan(TwoArms())); }
  Definition more = TwoArms();
  more.arms.push_back({"c", {{"learner.batch", 32}}});
  more.seeds = {3, 1, 7};
  EXPECT_EQ(Refusal(more), "");
  EXPECT_EQ(ReadExperiment(path_).definition.arms.size(), 3u);
}

// These members change the summary only, not the runs.
TEST_F(ExperimentFolderTest, OtherFramesAndReferencesAreTaken) {
  Definition definition = TwoArms();
  definition.frames = {100};
  { const ExperimentFolder first(Plan(definition)); }
  definition.frames = {100, 500};
  definition.reference = "planet-6";
  EXPECT_EQ(Refusal(definition), "");
  EXPECT_EQ(ReadExperiment(path_).definition.frames, definition.frames);
  EXPECT_EQ(ReadExperiment(path_).definition.reference, "planet-6");
  definition.reference = "nope";
  EXPECT_THAT(Refusal(definition), HasSubstr("x.json: reference: no reference 'nope'"));
  EXPECT_EQ(ReadExperiment(path_).definition.reference, "planet-6");
}

TEST_F(ExperimentFolderTest, AnotherExperimentIsRefusedAndNothingChanges) {
  { const ExperimentFolder first(Plan(TwoArms())); }
  const std::string before = ReadFile(path_ / "experiment.json");
  Definition other = TwoArms();
  other.name = "other";
  EXPECT_THAT(Refusal(other), HasSubstr("'mine', not 'other'"));
  other = TwoArms();
  other.base = "hopper-state";
  EXPECT_THAT(Refusal(other), HasSubstr("hopper-state"));
  other = TwoArms();
  other.arms[0].set["learner.batch"] = 65;
  EXPECT_THAT(Refusal(other), HasSubstr("arm 'a'"));
  other = TwoArms();
  other.arms.pop_back();
  EXPECT_THAT(Refusal(other), HasSubstr("arm 'b'"));
  other = TwoArms();
  std::swap(other.arms[0], other.arms[1]);
  EXPECT_THAT(Refusal(other), HasSubstr("first arm, which ratios are taken to, is 'a', not 'b'"));
  other = TwoArms();
  other.set["env_steps"] = 10;
  EXPECT_THAT(Refusal(other), HasSubstr("env_steps"));
  other = TwoArms();
  other.final_episodes = 5;
  EXPECT_THAT(Refusal(other), HasSubstr("final_episodes"));
  EXPECT_EQ(ReadFile(path_ / "experiment.json"), before);
}

TEST_F(ExperimentFolderTest, SomethingElseIsNotUsed) {
  fs::create_directories(path_);
  WriteFileAtomically(path_ / "thesis.tex", "years of work");
  EXPECT_THAT(Refusal(TwoArms()), HasSubstr("something else"));
  EXPECT_EQ(std::distance(fs::directory_iterator(path_), fs::directory_iterator()), 1);
}

TEST_F(ExperimentFolderTest, APlanFindsWhatTheFolderRefusesAndMakesNothing) {
  Plan(TwoArms());
  EXPECT_FALSE(fs::exists(path_));
  {
    const ExperimentFolder first(Plan(TwoArms()));
    Plan(TwoArms());  // held or not: nothing is to be written
  }
  Definition other = TwoArms();
  other.name = "other";
  EXPECT_THROW(Plan(other), Error);
  fs::remove(path_ / "experiment.json");
  EXPECT_THROW(Plan(TwoArms()), Error) << "its runs are something else now";
}

TEST_F(ExperimentFolderTest, WhatCameBetweenPlanAndLockIsSeen) {
  Definition other = TwoArms();
  other.arms[0].set["learner.batch"] = 65;
  const ExperimentPlan late = Plan(other);
  { const ExperimentFolder first(Plan(TwoArms())); }
  EXPECT_THROW(ExperimentFolder{late}, Error);
  EXPECT_FALSE(IsExperimentHeld(path_));
  EXPECT_EQ(ReadExperiment(path_).definition.arms[0].set.at("learner.batch"), 64);
}

TEST_F(ExperimentFolderTest, WhatAKilledCommandLeftIsNoObstacle) {
  fs::create_directories(path_);
  WriteFileAtomically(path_ / ".lock", "");
  WriteFileAtomically(path_ / "experiment.json.tmp-77", "{\"sch");
  EXPECT_EQ(Refusal(TwoArms()), "");
}

TEST_F(ExperimentFolderTest, ABadArmIsRefusedBeforeAnythingIsWritten) {
  Definition bad = TwoArms();
  bad.arms[1].set["learner.bach"] = 3;
  EXPECT_THAT(Refusal(bad), HasSubstr("learner.bach"));
  EXPECT_FALSE(fs::exists(path_));
}

TEST_F(ExperimentFolderTest, OnlyOneProcessRunsIt) {
  {
    const ExperimentFolder first(Plan(TwoArms()));
    EXPECT_TRUE(IsExperimentHeld(path_));
    EXPECT_THAT(Refusal(TwoArms()), HasSubstr("is being run"));
  }
  EXPECT_FALSE(IsExperimentHeld(path_));
  EXPECT_EQ(Refusal(TwoArms()), "");
}

TEST_F(ExperimentFolderTest, RunsOfOtherSeedsAreFound) {
  const ExperimentFolder open(Plan(TwoArms()));
  for (const char* name : {"a-s12", "b-s5", "b-s5x", "c-s4", "b-s-2"}) {
    fs::create_directories(path_ / "runs" / name);
  }
  open.experiment().Log().Write(RunStart{.run = "b-s20"});  // refused before it had a folder
  open.experiment().Log().Write(RunStart{.run = "a-s3"});
  std::vector<int64_t> seeds;
  for (const auto& run : open.experiment().Runs()) {
    if (run.arm == 0) seeds.push_back(run.seed);
  }
  EXPECT_THAT(seeds, testing::ElementsAre(3, 1, 5, 12, 20));
}

TEST_F(ExperimentFolderTest, SingleRunsShareItButNotWithACommandThatRunsItWhole) {
  { const ExperimentFolder made(Plan(TwoArms())); }
  {
    const ExperimentShare one(path_), other(path_);
    EXPECT_EQ(other.experiment().definition.name, "mine");
    EXPECT_TRUE(IsExperimentHeld(path_));
    EXPECT_THAT(Refusal(TwoArms()), HasSubstr("is being run by another process"));
  }
  EXPECT_FALSE(IsExperimentHeld(path_));
  EXPECT_EQ(Refusal(TwoArms()), "");
}

TEST_F(ExperimentFolderTest, RunsAreFoundByTheirNames) {
  const ExperimentFolder open(Plan(TwoArms()));
  const auto run = open.experiment().RunNamed("b-s17");
  ASSERT_TRUE(run);
  EXPECT_EQ(run->arm, 1u);
  EXPECT_EQ(run->seed, 17);
  for (const std::string name : {"c-s1", "b-s", "b-s1x", "b"}) {
    EXPECT_FALSE(open.experiment().RunNamed(name)) << name;
  }
}

}  // namespace
}  // namespace shoal::launch
