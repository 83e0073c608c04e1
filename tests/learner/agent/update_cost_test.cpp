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

// From state the networks are counted by hand: actor 3 x 8 + 8 x 4 (mean and deviation), each Q
// 5 x 8 + 8 x 1.
TEST(UpdateCost, CountsTheProductsOfAllPasses) {
  const double actor = 3 * 8 + 8 * 4, critics = 2 * (5 * 8 + 8);
  const UpdateCost cost = CostOfUpdate(SmallNetworks("sac"), State());
  EXPECT_EQ(cost.encoder_parameters, 0);
  EXPECT_DOUBLE_EQ(cost.flop, 2 * 10 * (4 * critics + actor + (3 * actor + 2 * critics) / 2));
  // DDPG's have one Q and no deviation.
  const double mean = 3 * 8 + 8 * 2, critic = critics / 2;
  EXPECT_DOUBLE_EQ(CostOfUpdate(SmallNetworks("ddpg"), State()).flop,
                   2 * 10 * (4 * critic + mean + (3 * mean + 2 * critic) / 2));
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

TEST(UpdateCost, PicturesCostTheEncodersMaps) {
  Config config = SmallNetworks("sac");
  config.network.encoder = "nature";
  ObservationSpec spec = State();
  spec.cameras = {"front"};
  spec.channels = 3;
  spec.height = spec.width = 84;
  spec.stack = 1;
  const UpdateCost cost = CostOfUpdate(config, spec);
  // Mnih et al. 2015: 8x8/4, 4x4/2, 3x3/1 of 32, 64, 64 filters; maps of 20, 9 and 7 pixels' side.
  const double weights[] = {3 * 64 * 32, 32 * 16 * 64, 64 * 9 * 64};
  EXPECT_EQ(static_cast<double>(cost.encoder_parameters),
            weights[0] + weights[1] + weights[2] + 32 + 64 + 64);
  const double maps = 400 * weights[0] + 81 * weights[1] + 49 * weights[2];
  EXPECT_GT(cost.flop, 2 * 10 * 4 * maps);
  EXPECT_LT(cost.flop, 2 * 10 * 4 * maps * 1.5) << "trunks and heads are small beside it";
  config.network.target_encoder = true;
  EXPECT_DOUBLE_EQ(CostOfUpdate(config, spec).flop - cost.flop, 2 * 10 * maps);
  // In every second update: there and back for the actor, there for the critic.
  config.network.encoders = "separate";
  EXPECT_DOUBLE_EQ(CostOfUpdate(config, spec).flop - cost.flop, 2 * 10 * (1 + 4 / 2.0) * maps);
}

}  // namespace
}  // namespace shoal::learner
