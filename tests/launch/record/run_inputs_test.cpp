// SPDX-License-Identifier: Apache-2.0
#include "launch/record/run_inputs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace shoal::launch {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// FetchPush from pixels with what the gripper feels and the goal's position.
RunConfig PushRun() {
  RunConfig run;
  run.spec.task = "FetchPush";
  run.spec.cameras = {"front", "side"};
  run.spec.channels = 6;
  run.spec.height = run.spec.width = 64;
  run.spec.action_size = 4;
  run.spec.blocks = {{"grip", 3},
                     {"object", 3, /*observed=*/false},
                     {"object_velocity_from_grip", 3, /*observed=*/false},
                     {"achieved_goal", 3, /*observed=*/false},
                     {"desired_goal", 3}};
  run.config.replay.hindsight = "future";
  run.config.sac.critic_blocks = StateBlocks(std::vector<std::string>{"object"});
  run.config.sac.aux = {"object-grip"};
  return run;
}

TEST(RunInputs, SayWhatThePolicyGetsAndWhatTrainingAloneIsTold) {
  EXPECT_EQ(DescribeInputs(PushRun()),
            "FetchPush: what the policy gets, in training and at test time:\n  pictures  front, "
            "side at 64x64, 1 frame(s), the goal's marker hidden\n  numbers   grip (3), "
            "desired_goal (3)\nprivileged, in training alone:\n  the critic sees        object "
            "(3), in place of pixels\n  the encoder predicts   object-grip\n  the replay           "
            "  relabels goals with achieved_goal\nalso recorded: object_velocity_from_grip (3)\n");
}

// Neither network has the object as an input, but the samples are chosen by it.
TEST(RunInputs, WhatTheReplayGoesByIsPrivilegedToo) {
  RunConfig run = PushRun();
  run.config.sac.critic_blocks = false;
  run.config.sac.aux = {};
  run.config.replay.movement_share = 0.5;
  EXPECT_THAT(
      DescribeInputs(run),
      HasSubstr("privileged, in training alone:\n  the replay             relabels goals with "
                "achieved_goal and draws 50 % of the samples by its remaining path length\n"));
  run.config.replay.movement = "displacement";
  EXPECT_THAT(DescribeInputs(run),
              HasSubstr("50 % of the samples by its remaining displacement\n"));
  run.config.replay.hindsight = "none";
  run.config.replay.movement_share = 0;
  EXPECT_THAT(DescribeInputs(run), HasSubstr("privileged, in training alone: nothing\n"));
}

TEST(RunInputs, WhatThePolicyIsToldInNumbersIsNotPrivilegedInTheReplay) {
  RunConfig run = PushRun();
  run.config.sac.critic_blocks = false;
  run.config.sac.aux = {};
  run.spec.blocks[3].observed = true;  // observation.goal_mode = both
  EXPECT_THAT(DescribeInputs(run), HasSubstr("privileged, in training alone: nothing\n"));
  run.spec.blocks[3].observed = false;
  run.spec.cameras.clear();
  run.spec.channels = 0;
  EXPECT_THAT(DescribeInputs(run), HasSubstr("privileged, in training alone: nothing\n"));
}

TEST(RunInputs, NothingIsSaidToBeNothing) {
  RunConfig run;
  run.spec.task = "walker_walk";
  run.spec.blocks = {{"velocity", 9}};
  EXPECT_EQ(
      DescribeInputs(run),
      "walker_walk: what the policy gets, in training and at test time:\n  pictures  none\n  "
      "numbers   velocity (9)\nprivileged, in training alone: nothing\nalso recorded: nothing\n");
}

TEST(RunInputs, TheGoalsMarkerIsInPicturesUnlessItIsHidden) {
  RunConfig run = PushRun();
  run.config.replay.hindsight = "none";
  EXPECT_THAT(DescribeInputs(run), HasSubstr("1 frame(s), with the goal's marker\n"));
  run.spec.goal_picture = true;
  run.config.sac.critic_blocks = false;
  EXPECT_THAT(
      DescribeInputs(run),
      HasSubstr("1 frame(s) and a picture of the goal reached, the goal's marker hidden\n"));
  run.spec.blocks.resize(3);
  EXPECT_THAT(DescribeInputs(run), Not(HasSubstr("marker")));
}

TEST(RunInputs, BlocksThatTellOfTheObjectAreNamed) {
  ObservationSpec spec = PushRun().spec;
  EXPECT_THAT(PolicyInputsOf(spec).object_blocks, IsEmpty());
  for (BlockSpec& block : spec.blocks) block.observed = true;
  EXPECT_THAT(PolicyInputsOf(spec).object_blocks,
              ElementsAre("object", "object_velocity_from_grip", "achieved_goal"));
  RunConfig run = PushRun();
  run.spec = spec;
  run.config.sac.critic_blocks = false;  // which leaves nothing to a critic of its own
  EXPECT_THAT(DescribeInputs(run), HasSubstr("  of these describe the object: object, "));
  // The achieved goal of a gripper alone reveals only the gripper.
  std::erase_if(spec.blocks,
                [](const BlockSpec& block) { return block.name.starts_with("object"); });
  EXPECT_THAT(PolicyInputsOf(spec).object_blocks, IsEmpty());
}

TEST(RunInputs, ProgramsGetTheSame) {
  EXPECT_EQ(nlohmann::json(InputsJson(PushRun())), nlohmann::json::parse(R"({
    "schema": "shoal-inputs-1", "task": "FetchPush", "height": 64, "width": 64, "stack": 1,
    "policy_inputs": {"blocks": ["grip", "desired_goal"], "object_blocks": [],
                      "cameras": ["front", "side"], "goal_picture": false},
    "privileged_inputs": {"critic_blocks": ["object"], "labels": ["object-grip"],
                          "replay_blocks": ["achieved_goal"]},
    "recorded_blocks": [{"name": "grip", "size": 3}, {"name": "object", "size": 3},
                        {"name": "object_velocity_from_grip", "size": 3},
                        {"name": "achieved_goal", "size": 3}, {"name": "desired_goal", "size": 3}]
  })"));
}

}  // namespace
}  // namespace shoal::launch
