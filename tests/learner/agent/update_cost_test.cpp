// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/update_cost.h"

#include <gtest/gtest.h>

namespace shoal::learner {
namespace {

Config SmallNetworks(const std::string& algorithm) {
  Config config;
  config.learner.algorithm = algorithm;
  config.learner.batch = 10;
  config.learner.actor_period = 2;
  config.network.hidden = {8};
  config.network.layer_norm = false;
  return config;
}

ObservationSpec State() {
  ObservationSpec spec;
  spec.blocks = {{"position", 3, true}};
  spec.action_size = 2;
  return spec;
}

// Networks from state, counted by hand: actor 3 x 8 + 8 x 4 (mean and deviation), each Q 5 x 8 + 8
// x 1.
TEST(UpdateCost, CountsTheProductsOfAllPasses) {
  const double actor = 3 * 8 + 8 * 4, critics = 2 * (5 * 8 + 8);
  const UpdateCost cost = CostOfUpdate(SmallNetworks("sac"), State());
  EXPECT_EQ(cost.encoder_parameters, 0);
  EXPECT_DOUBLE_EQ(cost.flop, 2 * 10 * (4 * critics + actor + (3 * actor + 2 * critics) / 2));
  // An ensemble of five has two and a half times as many critics.
  Config five = SmallNetworks("sac");
  five.sac.critics = 5;
  EXPECT_DOUBLE_EQ(CostOfUpdate(five, State()).flop,
                   2 * 10 * (10 * critics + actor + (3 * actor + 5 * critics) / 2));
  // DDPG's have one Q and no deviation.
  const double mean = 3 * 8 + 8 * 2, critic = critics / 2;
  EXPECT_DOUBLE_EQ(CostOfUpdate(SmallNetworks("ddpg"), State()).flop,
                   2 * 10 * (4 * critic + mean + (3 * mean + 2 * critic) / 2));
}

// A block has 8 x 32 + 32 x 8.
TEST(UpdateCost, ResidualBlocksAreCounted) {
  Config config = SmallNetworks("sac");
  config.network.layer_norm = true;
  config.network.blocks = 3;
  const double blocks = 3 * 2 * 8 * 32;
  const double actor = 3 * 8 + blocks + 8 * 4, critics = 2 * (5 * 8 + blocks + 8);
  EXPECT_DOUBLE_EQ(CostOfUpdate(config, State()).flop,
                   2 * 10 * (4 * critics + actor + (3 * actor + 2 * critics) / 2));
}

// Latent state of 4 from layers 3 x 4, action layer 2 x 2, joint (4 + 2) x 8 + 8 x 8, heads 8 x (1
// + 4 + 65), policy 4 x 8 + 8 x 2, each Q 8 x 8 + 8 x 8 + 8 x 1.
TEST(UpdateCost, WithALatentModelItCountsTheModelsSteps) {
  Config config = SmallNetworks("mrq");
  config.network.state_hidden = {4};
  config.mrq.horizon = 5;
  const double state = 3 * 4, join = 2 * 2 + 6 * 8 + 8 * 8, heads = 8 * 70;
  const double actor = 4 * 8 + 8 * 2, critics = 2 * (64 + 64 + 8);
  const double model_step = 3 * state + 5 * state + 5 * 3 * (join + heads);
  const double targets = state + actor + join + critics;
  const double value_step = state + join + 3 * critics + 3 * actor + 2 * join + 2 * critics;
  EXPECT_DOUBLE_EQ(CostOfUpdate(config, State()).flop,
                   2 * 10 * (model_step + targets + value_step));
}

// Actor 3 x 8 + 8 x 2, value 3 x 8 + 8 x 1, for 6 steps of 2 x 5 environments in 4 epochs.
TEST(UpdateCost, OnPolicyItIsThatOfAWholeRollout) {
  Config config = SmallNetworks("ppo");
  config.actors = 2;
  config.envs_per_actor = 5;
  config.ppo.rollout_steps = 6;
  config.ppo.epochs = 4;
  const double actor = 3 * 8 + 8 * 2, value = 3 * 8 + 8;
  EXPECT_DOUBLE_EQ(CostOfUpdate(config, State()).flop, 2 * 60 * (value + 4 * 3 * (actor + value)));
  config.ppo.networks = "shared";
  const double both = 3 * 8 + 8 * 3;
  EXPECT_DOUBLE_EQ(CostOfUpdate(config, State()).flop, 2 * 60 * (both + 4 * 3 * both));
}

ObservationSpec StateAndPictures() {
  ObservationSpec spec = State();
  spec.cameras = {"front"};
  spec.channels = 3;
  spec.height = spec.width = 84;
  spec.stack = 1;
  return spec;
}

Config NatureEncoder(const std::string& algorithm) {
  Config config = SmallNetworks(algorithm);
  config.network.encoder = "nature";
  config.network.features = 6;
  return config;
}

// Mnih et al. 2015: 8x8/4, 4x4/2, 3x3/1 of 32, 64, 64 filters; maps of 20, 9 and 7 pixels' side.
constexpr double kNatureWeights[] = {3 * 64 * 32, 32 * 16 * 64, 64 * 9 * 64};
constexpr double kFirstMap = 400 * kNatureWeights[0];
constexpr double kForward = kFirstMap + 81 * kNatureWeights[1] + 49 * kNatureWeights[2];
// Gradients of weights and of maps; the first layer reads pixels, whose gradient nothing wants.
constexpr double kBackward = 2 * kForward - kFirstMap;
constexpr double kTrunk = 64 * 49 * 6;

TEST(UpdateCost, PicturesCostTheEncodersMaps) {
  Config config = NatureEncoder("sac");
  const ObservationSpec spec = StateAndPictures();
  const UpdateCost cost = CostOfUpdate(config, spec);
  EXPECT_EQ(static_cast<double>(cost.encoder_parameters),
            kNatureWeights[0] + kNatureWeights[1] + kNatureWeights[2] + 32 + 64 + 64);
  const double actor = kTrunk + (6 + 3) * 8 + 8 * 4, critics = kTrunk + 2 * ((6 + 5) * 8 + 8);
  // A step of the actor computes no gradient of the features. Its own trunk needs none, because the
  // critic trains the encoder, and the critics' trunk has no action among its inputs.
  const double actor_step = 3 * actor - kTrunk + 2 * critics - kTrunk;
  EXPECT_DOUBLE_EQ(cost.flop,
                   2 * 10 * (2 * kForward + kBackward + 4 * critics + actor + actor_step / 2));
  config.network.target_encoder = true;
  EXPECT_DOUBLE_EQ(CostOfUpdate(config, spec).flop - cost.flop, 2 * 10 * kForward);
  // In every second update: there and back for the actor and its trunk, there for the critic.
  config.network.encoders = "separate";
  EXPECT_DOUBLE_EQ(CostOfUpdate(config, spec).flop - cost.flop,
                   2 * 10 * (kForward + (2 * kForward + kBackward + kTrunk) / 2));
}

TEST(UpdateCost, OnPolicyPicturesCostTheEncodersMapsInEachEpoch) {
  Config config = NatureEncoder("ppo");
  config.actors = config.envs_per_actor = 1;
  config.ppo.rollout_steps = 6;
  config.ppo.epochs = 4;
  const double actor = kTrunk + (6 + 3) * 8 + 8 * 2, value = kTrunk + (6 + 3) * 8 + 8;
  EXPECT_DOUBLE_EQ(
      CostOfUpdate(config, StateAndPictures()).flop,
      2 * 6 * (kForward + value + 4 * (2 * kForward + 2 * kBackward + 3 * (actor + value))));
  config.ppo.networks = "shared";
  const double both = kTrunk + (6 + 3) * 8 + 8 * 3;
  EXPECT_DOUBLE_EQ(CostOfUpdate(config, StateAndPictures()).flop,
                   2 * 6 * (kForward + both + 4 * (kForward + kBackward + 3 * both)));
}

}  // namespace
}  // namespace shoal::learner
