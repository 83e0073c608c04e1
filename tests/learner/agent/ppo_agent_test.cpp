// SPDX-License-Identifier: Apache-2.0
#include "learner/agent/ppo/ppo_agent.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "common/nn/policy.h"
#include "learner/agent/ppo/advantages.h"
#include "learner/agent/ppo/reward_scale.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

Config PpoConfigOf(const Config& base) {
  Config config = base;
  config.learner.algorithm = "ppo";
  config.learner.max_grad_norm = 0.5;
  config.ppo.epochs = 2;
  return config;
}

RandomBatch RandomRollout(const ObservationSpec& spec, int rows, uint64_t key) {
  return {spec, rows, key, /*rollout=*/true};
}

// Log-probabilities as those of an untrained policy, whose means are about 0 and deviations 1.
void ActUntrained(const BatchView& rollout) {
  const size_t actions = rollout.drawn_action.size() / rollout.rows();
  for (size_t i = 0; i < rollout.rows(); ++i) {
    rollout.log_prob[i] = -0.9189385f * float(actions);
    for (const float u : rollout.drawn_action.subspan(i * actions, actions)) {
      rollout.log_prob[i] -= u * u / 2;
    }
  }
}

TEST(Advantages, AreThoseByHandWithATimeLimitAndATermination) {
  // Steps 0, 1: a time limit after 1; step 2 terminates; step 3 is the rollout's last.
  const std::vector<float> reward{1, 2, 3, 4}, bootstrap{1, 1, 0, 1}, continues{1, 0, 0, 0};
  const std::vector<float> value{10, 20, 30, 40}, next_value{20, 6, 99, 8};
  std::vector<float> advantage(4), target(4);
  Advantages({reward, bootstrap, continues, value, next_value, 0.5, 0.5}, advantage, target);
  // delta: 1+10-10, 2+3-20, 3-30, 4+4-40; only step 0 goes on: 1 + 0.25 * -15.
  EXPECT_EQ(advantage, (std::vector<float>{-2.75f, -15, -27, -32}));
  EXPECT_EQ(target, (std::vector<float>{7.25f, 5, 3, 8}));
}

TEST(ExplainedVariance, IsOneOfTheTargetsThemselvesAndZeroOfAConstant) {
  const std::vector<float> target{1, 2, 4}, constant{5, 5, 5};
  EXPECT_NEAR(ExplainedVariance(target, target), 1, 1e-12);
  EXPECT_NEAR(ExplainedVariance(constant, target), 0, 1e-12);
  EXPECT_EQ(ExplainedVariance(target, constant), 0);
}

TEST(RewardScale, ReturnsGoOnFromRolloutToRolloutAndBeginAnewWithEpisodes) {
  RewardScale scale(0.5);
  const std::vector<uint64_t> env{3, 3, 3};
  scale.Scale(std::vector<float>{1, 1, 1}, std::vector<float>{0, 1, 0}, env);  // G: 1, 1.5 | 1
  const auto second = scale.Scale(std::vector<float>{1, 0, 0}, std::vector<float>{0, 0, 0}, env);
  // G: 1.5, 0.75, 0.375, with the three before: mean 1.0208, variance 0.1584.
  EXPECT_NEAR(second[0], 1 / std::sqrt(0.15842), 1e-3);
}

class PpoAgentTest : public testing::TestWithParam<const char*> {
 protected:
  PpoAgentTest() {
    config_ = PpoConfigOf(SmallConfig());
    config_.ppo.networks = GetParam();
    config_.learner.normalise_vectors = config_.ppo.normalise_rewards = true;
    spec_.drawn_actions = true;
  }
  std::unique_ptr<Agent> Make() const { return MakeAgent(config_, spec_, nn::Precision::kF32); }

  Config config_;
  ObservationSpec spec_ = SmallSpec();
};

TEST_P(PpoAgentTest, ARestoredAgentGoesOnBitForBit) {
  const auto one = Make(), other = Make();
  for (uint64_t u = 0; u < 2; ++u)
    ASSERT_TRUE(one->Update(RandomRollout(spec_, 12, u).View()).finite);
  other->Restore(one->AllTensors(), "test");
  EXPECT_EQ(other->updates(), 2u);
  const RandomBatch next = RandomRollout(spec_, 12, 9);
  ASSERT_TRUE(one->Update(next.View()).finite);
  ASSERT_TRUE(other->Update(next.View()).finite);
  const nn::TensorMap a = one->AllTensors(), b = other->AllTensors();
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [name, tensor] : a) EXPECT_EQ(tensor.data, b.at(name).data) << name;
}

TEST_P(PpoAgentTest, WhatIsNotFiniteChangesNothing) {
  const auto agent = Make();
  const nn::TensorMap before = agent->AllTensors();
  const RandomBatch rollout = RandomRollout(spec_, 12, 1);
  // Finite itself, but its loss is not.
  for (float& log_prob : rollout.View().log_prob) log_prob = -3e38f;
  EXPECT_FALSE(agent->Update(rollout.View()).finite);
  EXPECT_EQ(agent->updates(), 0u);
  for (const auto& [name, tensor] : agent->AllTensors()) {
    EXPECT_EQ(tensor.data, before.at(name).data) << name;
  }
}

TEST_P(PpoAgentTest, ThePolicyActsAsTheAgentSees) {
  const auto agent = Make();
  const RandomBatch rollout = RandomRollout(spec_, 12, 3);
  ASSERT_TRUE(agent->Update(rollout.View()).finite);
  nn::Policy policy(config_.network, spec_, nn::Precision::kF32, 1);
  policy.Load(agent->PolicyTensors(), "agent");
  const auto view = rollout.View();
  const nn::PolicyOutput out = policy.Forward(1, view.obs_frames.data(), view.obs_vector.data());
  EXPECT_FALSE(out.squashed);
  ASSERT_EQ(out.log_std.size(), 2u);
  EXPECT_EQ(out.log_std[0], Floats(agent->AllTensors(), "actor.log_std")[0]);
  EXPECT_EQ(Floats(agent->PolicyTensors(), "observation.mean").size(), 2u);
  // Gains of 0.01: the untrained policy's means are small.
  EXPECT_LT(std::abs(out.mean[0]), 0.5);
}

TEST_P(PpoAgentTest, RowsBeyondWholeMinibatchesAreLeftOut) {
  const auto agent = Make();
  const UpdateOutcome outcome = agent->Update(RandomRollout(spec_, 15, 3).View());
  ASSERT_TRUE(outcome.finite);
  EXPECT_EQ(Get(outcome, kMinibatches), 2 * 2);  // 15 / 6 in each of two epochs
  EXPECT_EQ(Get(outcome, kRolloutSteps), 15);
}

TEST_P(PpoAgentTest, EndsAnUpdateThatMovesThePolicyTooFar) {
  config_.ppo.epochs = 50;
  config_.learner.learning_rate = 1e-2;
  config_.ppo.target_kl = 0.01;
  const UpdateOutcome outcome = Make()->Update(RandomRollout(spec_, 12, 3).View());
  EXPECT_LT(Get(outcome, kMinibatches), 100);
}

// The minibatch that moved too far is looked at, but not stepped with.
TEST_P(PpoAgentTest, TheLastMinibatchOfAnEndedUpdateChangesNothing) {
  config_.ppo.epochs = 50;
  config_.learner.learning_rate = 1e-2;
  const RandomBatch rollout = RandomRollout(spec_, 6, 3);  // a minibatch an epoch
  ActUntrained(rollout.View());
  config_.ppo.target_kl = 0.02;
  const auto ended = Make();
  const double steps = Get(ended->Update(rollout.View()), kMinibatches);
  ASSERT_GT(steps, 1);
  ASSERT_LT(steps, 50);
  config_.ppo.target_kl = 0;
  config_.ppo.epochs = int(steps);
  const auto whole = Make();
  EXPECT_EQ(Get(whole->Update(rollout.View()), kMinibatches), steps);
  EXPECT_TRUE(Differences(ended->AllTensors(), whole->AllTensors()).empty());
}

INSTANTIATE_TEST_SUITE_P(Networks, PpoAgentTest, testing::Values("separate", "shared"));

// A bandit: reward -(a - s0 / 2)^2, each step an episode.
TEST(PpoAgent, LearnsABandit) {
  ObservationSpec spec;
  spec.task = "bandit";
  spec.blocks = {{"state", 2}};
  spec.action_size = 1;
  spec.drawn_actions = true;
  Config config = PpoConfigOf(Config());
  config.learner.batch = 64;
  config.learner.learning_rate = 3e-3;
  config.network.hidden = {32, 32};
  config.network.layer_norm = false;
  config.network.activation = "tanh";
  config.ppo.epochs = 8;
  const auto agent = MakeAgent(config, spec, nn::Precision::kF32);
  nn::Policy policy(config.network, spec, nn::Precision::kF32, 1);
  Random random(1);
  for (uint64_t u = 0; u < 60; ++u) {
    policy.Load(agent->PolicyTensors(), "agent");
    const RandomBatch rollout = RandomRollout(spec, 256, u);
    const BatchView view = rollout.View();
    for (size_t b = 0; b < view.reward.size(); ++b) {
      view.obs_vector[2 * b] = float(random.Uniform(-1, 1));
      const auto out = policy.Forward(1, nullptr, &view.obs_vector[2 * b]);
      const double noise = random.Normal();
      const double action = out.mean[0] + std::exp(out.log_std[0]) * noise;
      view.drawn_action[b] = float(action);
      view.log_prob[b] = float(-noise * noise / 2 - out.log_std[0] - 0.9189385);
      view.reward[b] = float(-std::pow(action - view.obs_vector[2 * b] / 2, 2));
      view.bootstrap[b] = view.continues[b] = 0;
      view.ends[b] = 1;
    }
    ASSERT_TRUE(agent->Update(view).finite);
  }
  policy.Load(agent->PolicyTensors(), "agent");
  double error = 0;
  for (int i = 0; i < 41; ++i) {
    const float state[2] = {float(i - 20) / 20, 0.f};
    error += std::abs(policy.Forward(1, nullptr, state).mean[0] - state[0] / 2) / 41;
  }
  EXPECT_LT(error, 0.08);  // 0.25 of a policy that ignores the state
}

}  // namespace
}  // namespace shoal::learner
