// SPDX-License-Identifier: Apache-2.0
#include "launch/run/plan_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/config_io.h"

namespace shoal::launch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(PlanText, FromStateThereAreNoPicturesAndNoEncoder) {
  RunConfig run;
  run.config.observation.pixels = false;
  run.config.replay.capacity = 2000;
  run.config.replay.samples_per_insert = Schedule::Constant(64);
  run.config.learner.batch = 256;
  run.spec.blocks = {{"position", 3, true}};
  run.spec.action_size = 2;
  EXPECT_THAT(PlanText(run, 0),
              AllOf(HasSubstr("no pictures; replay of 2000 records: "), HasSubstr("in a file"),
                    HasSubstr("0.25 updates per env step; sac in f32: batch 256, "),
                    Not(HasSubstr("encoder"))));
}

TEST(SharedCoresText, MoreActorsThanCoresAreSaid) {
  EXPECT_EQ(SharedCoresText(2, 2), "");
  EXPECT_EQ(SharedCoresText(3, 2),
            "3 actors share 2 core(s): actors and learner get less time each");
}

TEST(PlanText, AScheduleOfUpdatesIsSaidWithBothEnds) {
  RunConfig run;
  run.config.observation.pixels = false;
  run.config.replay.samples_per_insert = Schedule{64, 16, 50'000};
  run.config.learner.batch = 256;
  run.spec.blocks = {{"position", 3, true}};
  run.spec.action_size = 2;
  EXPECT_THAT(PlanText(run, 0), HasSubstr("  0.25 updates per env step at the start, 0.0625 from "
                                          "50000 env steps on; sac in f32"));
}

TEST(PlanText, PicturesSayWhatTheyCost) {
  RunConfig run;
  run.config.observation.quality = "reference";
  run.config.replay.samples_per_insert = Schedule::Constant(0);
  run.config.replay.storage = "memory";
  run.config.learner.precision = "f32";
  run.config.network.encoder = "nature";
  run.spec.cameras = {"front", "side"};
  run.spec.channels = 6;
  run.spec.height = run.spec.width = 84;
  run.spec.stack = 1;
  run.spec.action_size = 2;
  EXPECT_THAT(PlanText(run, 1234.4),
              AllOf(HasSubstr("OSMesa (reference) draws a frame, 2 camera(s), in 1234 us"),
                    HasSubstr("in memory"), HasSubstr("updates as fast as the learner can"),
                    HasSubstr("sac in f32: encoder nature of 82080 parameters, ")));
  run.config.observation.quality = "native";
  EXPECT_THAT(PlanText(run, 34.4),
              HasSubstr("Shoal's renderer (native) draws a frame, 2 camera(s), in 34 us"));
}

TEST(PlanText, WhatOnlyTrainingIsToldIsSaid) {
  RunConfig run;
  run.spec.cameras = {"front"};
  run.spec.channels = 3;
  run.spec.height = run.spec.width = 84;
  run.spec.action_size = 2;
  run.spec.blocks = {{"grip", 3}, {"object", 3, /*observed=*/false}};
  EXPECT_THAT(PlanText(run, 1), Not(HasSubstr("privileged")));
  run.config.sac.critic_blocks = true;
  run.config.sac.aux = {"object-grip"};
  EXPECT_THAT(PlanText(run, 1),
              HasSubstr("  privileged, in training alone: the critic sees object in place of "
                        "pixels, the encoder predicts object-grip\n"));
  run.spec.blocks.push_back({"achieved_goal", 3, /*observed=*/false});
  run.config.replay.hindsight = "future";
  run.config.replay.movement_share = 0.25;
  EXPECT_THAT(PlanText(run, 1),
              HasSubstr("predicts object-grip, the replay relabels goals with achieved_goal and "
                        "draws 25 % of the samples by its remaining path length\n"));
}

TEST(PlanText, APolicyThatIsToldOfTheObjectBesidePicturesIsNamed) {
  RunConfig run;
  run.spec.cameras = {"front"};
  run.spec.channels = 3;
  run.spec.height = run.spec.width = 84;
  run.spec.action_size = 2;
  run.spec.blocks = {{"grip", 3},
                     {"object", 3, /*observed=*/false},
                     {"achieved_goal", 3, /*observed=*/false},
                     {"desired_goal", 3}};
  const auto said = HasSubstr("the policy gets the object's position");
  EXPECT_THAT(PlanText(run, 1), Not(said));
  run.spec.blocks[1].observed = true;  // observation.proprioception
  EXPECT_THAT(PlanText(run, 1), HasSubstr("  besides its pictures the policy gets the object's "
                                          "position, also at test time: object\n"));
  run.spec.blocks[1].observed = false;
  run.spec.blocks[2].observed = true;  // observation.goal_mode = both
  EXPECT_THAT(PlanText(run, 1), HasSubstr("also at test time: achieved_goal\n"));
  run.spec.cameras = {};  // a policy from state: no need to say so
  run.spec.channels = run.spec.height = run.spec.width = 0;
  run.config.observation.pixels = false;
  EXPECT_THAT(PlanText(run, 0), Not(said));
}

TEST(PlanText, OneFrameOfATaskOfMotionIsSaidToShowNoVelocity) {
  RunConfig run;
  run.config.task = "walker_walk";
  run.config.preset = "of-ours";
  run.spec.cameras = {"side"};
  run.spec.channels = 3;
  run.spec.height = run.spec.width = 84;
  run.spec.action_size = 6;
  const auto said = HasSubstr("observation.stack = 1: the policy sees no velocity");
  EXPECT_THAT(PlanText(run, 1), said);
  RunConfig stacked = run;
  stacked.config.observation.stack = 3;
  EXPECT_THAT(PlanText(stacked, 1), Not(said));
  RunConfig reach = run;
  reach.config.task = "FetchReachDense";
  EXPECT_THAT(PlanText(reach, 1), Not(said));
  run.spec.blocks = {{"velocity", 9}};
  EXPECT_THAT(PlanText(run, 1), Not(said));
}

TEST(PlanText, WhatAPresetSaysForAnotherTaskIsNamed) {
  RunConfig run;
  run.config = LoadPreset("fetch-reach-drq");
  run.config.observation.pixels = false;
  run.spec.action_size = 6;
  run.spec.blocks = {{"velocity", 9}};
  EXPECT_THAT(PlanText(run, 0), Not(HasSubstr("needs it")));
  run.config.task = "walker_walk";
  EXPECT_THAT(PlanText(run, 0), HasSubstr("  preset fetch-reach-drq: learner.discount = 0.6, "
                                          "learner.reward_scale = 10 as FetchReachDense needs "
                                          "it\n"));
  run.config.learner.discount = 0.99;
  EXPECT_THAT(PlanText(run, 0),
              HasSubstr("fetch-reach-drq: learner.reward_scale = 10 as FetchReachDense"));
}

TEST(PlanText, APresetForAnyTaskIsForNoOther) {
  RunConfig run;
  run.config = LoadPreset("state");
  run.config.task = "walker_walk";
  run.spec.action_size = 6;
  run.spec.blocks = {{"velocity", 9}};
  EXPECT_THAT(PlanText(run, 0), Not(HasSubstr("needs it")));
}

TEST(PlanText, WithoutAPresetDefaultsOfAnotherTaskAreNamed) {
  RunConfig run;
  run.config.task = "walker_walk";
  run.config.observation.pixels = false;
  run.spec.action_size = 6;
  run.spec.blocks = {{"velocity", 9}};
  EXPECT_THAT(PlanText(run, 0),
              HasSubstr("  no preset: learner.discount = 0.9, "
                        "learner.reward_scale = 10 as FetchReachDense needs it\n"));
  run.config.learner.discount = 0.99;
  EXPECT_THAT(PlanText(run, 0), HasSubstr("no preset: learner.reward_scale = 10 as"));
  run.config.preset = "of-ours";
  EXPECT_THAT(PlanText(run, 0), Not(HasSubstr("needs it"))) << "nor can it be looked up";
}

}  // namespace
}  // namespace shoal::launch
