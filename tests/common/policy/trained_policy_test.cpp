// SPDX-License-Identifier: Apache-2.0
#include "common/policy/trained_policy.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "tests/common/policy/actors_actions.h"
#include "tests/common/policy/checkpoint_fixture.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::policy {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

std::vector<ObservedBlock> BlocksOf(const RandomObservations& random) {
  std::vector<ObservedBlock> blocks;
  for (const auto& [name, values] : random.blocks) blocks.push_back({name, values});
  return blocks;
}

std::vector<float> Act(TrainedPolicy* policy, const RandomObservations& random) {
  std::vector<float> actions(size_t(random.count) * size_t(policy->spec().action_size));
  const std::vector<ObservedBlock> blocks = BlocksOf(random);
  policy->Act({.count = random.count, .pixels = random.pixels, .blocks = blocks}, actions);
  return actions;
}

void ExpectTheActorsActions(const RunConfig& run, const fs::path& checkpoint) {
  TrainedPolicy policy(checkpoint);
  const RandomObservations random(run.spec, 4, 5);
  const std::vector<float> actions = Act(&policy, random);
  EXPECT_EQ(actions, ActorsActions(run, checkpoint, random));
  for (const float action : actions) EXPECT_LE(std::abs(action), 1);
  EXPECT_NE(actions[0], actions[size_t(run.spec.action_size)]) << "depends on what is seen";
}

TEST(TrainedPolicy, PlaysWhatTheActorPlaysByEveryAlgorithm) {
  for (const std::string algorithm : {"sac", "td3", "ddpg", "drqv2", "mrq", "ppo"}) {
    for (const bool pixels : {false, true}) {
      SCOPED_TRACE(algorithm + (pixels ? ", pixels" : ", state"));
      const TemporaryFolder folder;
      const RunConfig run = SmallRun(algorithm, pixels);
      ExpectTheActorsActions(run, WriteCheckpointOf(run, folder.path()));
    }
  }
}

class EncoderTest : public testing::TestWithParam<const char*> {};

TEST_P(EncoderTest, PlaysWhatTheActorPlays) {
  const TemporaryFolder folder;
  const RunConfig run = RunWithEncoder(GetParam());
  ExpectTheActorsActions(run, WritePolicyOf(run, folder.path()));
}

INSTANTIATE_TEST_SUITE_P(Every, EncoderTest,
                         testing::Values("compact", "drq", "mrq", "nature", "resnet18", "alexnet",
                                         "spatial_softmax"),
                         [](const auto& name) { return std::string(name.param); });

class SmallPolicyTest : public testing::Test {
 protected:
  // The message with which blocks are refused.
  std::string Refusal(const std::vector<ObservedBlock>& blocks, size_t pixels_less = 0,
                      size_t actions = 4) {
    const std::vector<float> before(actions, 7.f);
    std::vector<float> written = before;
    std::string message = ErrorMessage([&] {
      policy_.Act({.count = random_.count,
                   .pixels = std::span(random_.pixels).subspan(pixels_less),
                   .blocks = blocks},
                  written);
    });
    EXPECT_EQ(written, before) << "nothing is played";
    return message;
  }

  const TemporaryFolder folder_;
  const RunConfig run_ = SmallRun("sac", /*pixels=*/true);
  const std::filesystem::path checkpoint_ = WriteCheckpointOf(run_, folder_.path());
  TrainedPolicy policy_{checkpoint_};
  const RandomObservations random_{run_.spec, 2, 9};
  const std::vector<ObservedBlock> blocks_ = BlocksOf(random_);
};

TEST_F(SmallPolicyTest, TakesBlocksInAnyOrder) {
  std::vector<float> forwards(4), backwards(4);
  policy_.Act({2, random_.pixels, blocks_}, forwards);
  const std::vector<ObservedBlock> reversed(blocks_.rbegin(), blocks_.rend());
  policy_.Act({2, random_.pixels, reversed}, backwards);
  EXPECT_EQ(forwards, backwards);
}

// 64 + 64 + 4 + 1, each part a network of its own.
TEST_F(SmallPolicyTest, PlaysTheSameInEveryBatch) {
  const RandomObservations many(run_.spec, 133, 4);
  const std::vector<float> together = Act(&policy_, many);
  for (int n = 0; n < many.count; n += 12) {
    const auto stack = many.pixels.size() / size_t(many.count);
    std::vector<ObservedBlock> blocks;
    for (const auto& [name, values] : many.blocks) {
      const size_t size = values.size() / size_t(many.count);
      blocks.push_back({name, std::span(values).subspan(size_t(n) * size, size)});
    }
    std::vector<float> alone(2);
    policy_.Act({1, std::span(many.pixels).subspan(size_t(n) * stack, stack), blocks}, alone);
    for (size_t a = 0; a < 2; ++a) EXPECT_NEAR(alone[a], together[size_t(n) * 2 + a], 1e-5) << n;
  }
}

TEST_F(SmallPolicyTest, RefusesWhatDoesNotFitTheSpecByName) {
  EXPECT_EQ(Refusal({blocks_[0]}), "block 'goal' is missing: 2 numbers for each observation");
  EXPECT_EQ(Refusal({blocks_[0], blocks_[0], blocks_[1]}), "block 'grip' is given twice");
  EXPECT_EQ(Refusal({blocks_[0], blocks_[1], {"hidden", blocks_[0].values}}),
            "block 'hidden' is not observed by this policy, expected grip, goal");
  EXPECT_EQ(Refusal({blocks_[0], {"goal", blocks_[1].values.first(3)}}),
            "block 'goal': 3 numbers, expected 4 = 2 x 2");
  EXPECT_EQ(Refusal(blocks_, /*pixels_less=*/1),
            "pixels: 1151 bytes, expected 1152 = 2 x 2 x 18 x 16");
  EXPECT_EQ(Refusal(blocks_, 0, /*actions=*/3), "actions: room for 3 numbers, expected 4 = 2 x 2");
  EXPECT_EQ(ErrorMessage([&] {
              policy_.Act({0, {}, {}}, {});
            }),
            "0 observations, expected at least 1");
}

TEST_F(SmallPolicyTest, RefusesNumbersThatAreNotFinite) {
  std::vector<float> goal(blocks_[1].values.begin(), blocks_[1].values.end());
  goal[3] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(Refusal({blocks_[0], {"goal", goal}}),
            "block 'goal' holds a number that is not finite");
}

TEST_F(SmallPolicyTest, AnOutputThatIsNotFiniteIsNoAction) {
  CheckpointPolicy broken = ReadCheckpointPolicy(checkpoint_);
  std::vector<uint8_t>& bias = broken.tensors.at("actor.mlp.output.bias").data;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bias.data(), &nan, sizeof nan);
  TrainedPolicy policy(broken);
  std::vector<float> actions(4);
  EXPECT_EQ(ErrorMessage(3,
                         [&] {
                           policy.Act({2, random_.pixels, blocks_}, actions);
                         }),
            "the policy's output is not finite");
}

TEST_F(SmallPolicyTest, RefusesParametersThatDoNotFit) {
  CheckpointPolicy broken = ReadCheckpointPolicy(checkpoint_);
  broken.tensors.erase("actor.trunk.weight");
  EXPECT_THAT(ErrorMessage([&] { TrainedPolicy policy(broken); }),
              AllOf(HasSubstr(kPolicyFile), HasSubstr("actor.trunk.weight")));
}

}  // namespace
}  // namespace shoal::policy
