// SPDX-License-Identifier: Apache-2.0
#include "actor/evaluation/other_task.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "actor/acting/environments.h"
#include "common/base/error.h"

namespace shoal::actor {
namespace {

using testing::AllOf;
using testing::HasSubstr;

RunConfig StateRun(const std::string& task) {
  RunConfig run;
  run.config.task = task;
  run.config.observation.pixels = false;
  run.config.observation.proprioception = true;
  run.spec = worlds::MakeEnvironment(run.config, nullptr)->spec();
  return run;
}

std::string Refusal(const RunConfig& run, const std::string& task) {
  try {
    WithTask(run, task);
  } catch (const Error& e) {
    EXPECT_EQ(e.exit_code(), 2);
    return e.what();
  }
  return "accepted";
}

TEST(OtherTask, TakesASourcePolicyToTheTargetsOwnPhysics) {
  RunConfig source = StateRun("CustomHopper-source");
  source.config.randomization.body_mass = {{"thigh", {3.4, 4.4}}};
  const RunConfig target = WithTask(source, "CustomHopper-target");
  EXPECT_EQ(target.config.task, "CustomHopper-target");
  EXPECT_TRUE(target.config.randomization.body_mass.empty());
  EXPECT_EQ(target.spec, StateRun("CustomHopper-target").spec);
  EXPECT_NE(target.spec.Hash(), source.spec.Hash());
  // Actors accept it: they compare hashes.
  EXPECT_EQ(MakeEnvironments(target, 1).size(), 1u);
}

TEST(OtherTask, LeavesTheRunsModelFileBehind) {
  RunConfig run = StateRun("Hopper-v5");
  run.config.model = "somewhere/mine.xml";
  EXPECT_EQ(WithTask(run, "CustomHopper-target").config.model, "");
}

TEST(OtherTask, RefusesSizesThatThePolicyDoesNotTakeNamingBoth) {
  EXPECT_THAT(Refusal(StateRun("CustomHopper-source"), "cheetah_run"),
              AllOf(HasSubstr("does not fit"), HasSubstr("CustomHopper-source"),
                    HasSubstr("vector 11 [observation], action 3"),
                    HasSubstr("vector 17 [observation], action 6")));
}

TEST(OtherTask, WhatIsRecordedAndNotSeenMayDiffer) {
  const auto goal_only = [](const std::string& task) {
    RunConfig run;
    run.config.task = task;
    run.config.observation.pixels = false;
    run.config.observation.proprioception = StateBlocks({"grip", "fingers"});
    run.config.observation.goal_mode = "desired";
    run.spec = worlds::MakeEnvironment(run.config, nullptr)->spec();
    return run;
  };
  EXPECT_EQ(Refusal(goal_only("FetchReach"), "FetchPush"), "accepted");
}

TEST(OtherTask, RefusesOtherPictures) {
  RunConfig run = StateRun("Hopper-v5");
  run.config.observation.pixels = true;
  run.config.observation.cameras = {"track"};
  run.spec.channels = 3;
  EXPECT_THAT(Refusal(run, "cartpole_swingup"), HasSubstr("track"));
}

TEST(OtherTask, RefusesUnknownTasksByName) {
  EXPECT_THAT(Refusal(StateRun("Hopper-v5"), "Hoper"), HasSubstr("Hoper"));
}

}  // namespace
}  // namespace shoal::actor
