// SPDX-License-Identifier: Apache-2.0
#include "common/config/privileged_blocks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/config/batch_options.h"
#include "tests/support/error_message.h"

namespace shoal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

ObservationSpec PushSpec() {
  ObservationSpec spec;
  spec.task = "FetchPush";
  spec.blocks = {{"grip", 3},
                 {"object", 3, /*observed=*/false},
                 {"object-like", 3, false},
                 {"fingers", 2, false},
                 {"desired_goal", 3}};
  return spec;
}

Config Asking(StateBlocks critic, std::vector<std::string> aux = {}) {
  Config config;
  config.sac.critic_blocks = std::move(critic);
  config.sac.aux = std::move(aux);
  return config;
}

TEST(PrivilegedBlocks, AreThoseThatThePolicyDoesNotSeeInRecordOrder) {
  const auto blocks = PrivilegedBlocksOf(
      Asking(StateBlocks({"fingers", "grip"}), {"desired_goal-object", "object"}), PushSpec());
  EXPECT_THAT(blocks.critic, ElementsAre("fingers"));
  EXPECT_THAT(blocks.all, ElementsAre("object", "fingers"));
  ASSERT_EQ(blocks.labels.size(), 2u);
  EXPECT_EQ(blocks.labels[0].block, "desired_goal");
  EXPECT_EQ(blocks.labels[0].minus, "object");
  EXPECT_EQ(blocks.labels[0].size, 3);
  EXPECT_EQ(blocks.labels[1].block, "object");
  EXPECT_EQ(blocks.labels[1].minus, "");
}

TEST(PrivilegedBlocks, ACriticWithoutPixelsIsToldTheGoalThatAPictureShows) {
  ObservationSpec spec = PushSpec();
  spec.goal_picture = true;
  spec.blocks.back().observed = false;
  EXPECT_THAT(PrivilegedBlocksOf(Asking(StateBlocks({"object", "desired_goal"})), spec).critic,
              ElementsAre("object", "desired_goal"));
  EXPECT_THAT(UsageMessage([&] {
                PrivilegedBlocksOf(Asking(StateBlocks(std::vector<std::string>{"object"})), spec);
              }),
              testing::HasSubstr("expected 'desired_goal' among them"));
}

TEST(PrivilegedBlocks, ACriticThatWouldSeeNothingInPlaceOfThePixelsIsRefused) {
  EXPECT_EQ(UsageMessage([] {
              PrivilegedBlocksOf(Asking(StateBlocks({"desired_goal", "grip"})), PushSpec());
            }),
            "sac.critic_blocks: the policy of FetchPush observes all of desired_goal, grip, "
            "which leaves the critic nothing in place of the pixels; expected some of those that "
            "it does not observe: object (3), object-like (3), fingers (2)");
  ObservationSpec state = PushSpec();
  for (BlockSpec& block : state.blocks) block.observed = true;
  EXPECT_EQ(UsageMessage([&] { PrivilegedBlocksOf(Asking(true), state); }),
            "sac.critic_blocks: the policy of FetchPush observes all of the recorded blocks, "
            "which leaves the critic nothing in place of the pixels; expected some of those that "
            "it does not observe: none");
}

TEST(PrivilegedBlocks, AreNoneUnlessAskedFor) {
  EXPECT_THAT(PrivilegedBlocksOf(Asking(false), PushSpec()).all, IsEmpty());
  EXPECT_THAT(PrivilegedBlocksOf(Asking(true), PushSpec()).all,
              ElementsAre("object", "object-like", "fingers"));
}

TEST(PrivilegedBlocks, ADashInABlocksNameIsNoDifference) {
  const auto blocks = PrivilegedBlocksOf(Asking(false, {"object-like", "object-grip"}), PushSpec());
  EXPECT_EQ(blocks.labels[0].block, "object-like");
  EXPECT_EQ(blocks.labels[0].minus, "");
  EXPECT_EQ(blocks.labels[1].minus, "grip");
}

TEST(PrivilegedBlocks, OthersAreRefusedNamingThoseThereAre) {
  EXPECT_EQ(UsageMessage([] {
              PrivilegedBlocksOf(Asking(StateBlocks(std::vector<std::string>{"objekt"})),
                                 PushSpec());
            }),
            "sac.critic_blocks: FetchPush records no block 'objekt'; expected some of: grip "
            "(3), object (3), object-like (3), fingers (2), desired_goal (3)");
  EXPECT_EQ(UsageMessage([] { PrivilegedBlocksOf(Asking(false, {"object-gripp"}), PushSpec()); }),
            "sac.aux: FetchPush records no block 'gripp'; expected some of: grip (3), object "
            "(3), object-like (3), fingers (2), desired_goal (3)");
  EXPECT_EQ(UsageMessage([] { PrivilegedBlocksOf(Asking(false, {"object-fingers"}), PushSpec()); }),
            "sac.aux: 'object-fingers' is of 3 and 2 numbers, expected two blocks of one size");
}

TEST(PrivilegedBlocks, TravelInBatchesAndChangeTheirHash) {
  RunConfig run;
  run.spec = PushSpec();
  run.spec.action_size = 4;
  const uint64_t plain = BatchSchemaOf(run).Hash();
  EXPECT_FALSE(BatchSchemaOf(run).Has("obs_privileged"));
  run.config.sac.critic_blocks = StateBlocks({"object", "fingers"});
  const BatchSchema schema = BatchSchemaOf(run);
  EXPECT_TRUE(schema.Has("obs_privileged") && schema.Has("next_obs_privileged"));
  EXPECT_NE(schema.Hash(), plain);
  // The same number of numbers, with another meaning.
  run.config.sac.critic_blocks = StateBlocks({"object-like", "fingers"});
  EXPECT_NE(BatchSchemaOf(run).Hash(), schema.Hash());
}

}  // namespace
}  // namespace shoal
