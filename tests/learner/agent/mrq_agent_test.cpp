// SPDX-License-Identifier: Apache-2.0
// mrq_updates_test.cpp compares the losses with the published code.
#include "learner/agent/mrq/mrq_agent.h"

#include <gmock/gmock.h>

#include <cstring>
#include <numeric>

#include "common/nn/policy.h"
#include "learner/agent/mrq/reward_scales.h"
#include "tests/learner/agent/adam_moments.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

using testing::IsEmpty;
using testing::Not;

constexpr int kHorizon = 3, kPeriod = 2;

Config MrqConfigOf() {
  Config config = SmallConfig();
  config.learner.algorithm = "mrq";
  config.mrq.horizon = kHorizon;
  config.mrq.period = kPeriod;
  config.network.trunk = "elu";
  return config;
}

class MrqAgentTest : public testing::Test {
 protected:
  MrqAgentTest() : agent_(Make()) {}

  std::unique_ptr<Agent> Make() const { return MakeAgent(config_, spec_, nn::Precision::kF32); }

  RandomBatch Batch(uint64_t key) const {
    return {spec_, BatchOptions{.batch = config_.learner.batch, .horizon = kHorizon}, key};
  }

  UpdateOutcome Update(Agent* agent, uint64_t key) const {
    const RandomBatch batch = Batch(key);
    return agent->Update(batch.View());
  }

  ObservationSpec spec_ = SmallSpec();
  Config config_ = MrqConfigOf();
  std::unique_ptr<Agent> agent_;
};

TEST_F(MrqAgentTest, UntilThePeriodEndsOnlyTheTrainedNetworksChange) {
  const nn::TensorMap start = agent_->AllTensors();
  ASSERT_TRUE(Update(agent_.get(), 1).finite);
  const nn::TensorMap after = agent_->AllTensors();
  EXPECT_THAT(Differences(start, after, "target."), IsEmpty());
  EXPECT_THAT(Differences(start, after, "held."), IsEmpty());
  EXPECT_THAT(Differences(start, after, "encoder."), IsEmpty());
  EXPECT_THAT(Differences(start, after, "actor.trunk."), IsEmpty());
  EXPECT_THAT(Differences(start, after, "model."), Not(IsEmpty()));
  EXPECT_THAT(Differences(start, after, "critic."), Not(IsEmpty()));
  EXPECT_THAT(Differences(start, after, "actor.mlp."), Not(IsEmpty()));
}

TEST_F(MrqAgentTest, AtTheEndOfThePeriodTargetsAndHeldNetworksAreCopies) {
  agent_->Restore(Perturbed(agent_->AllTensors(), "model."), "test");
  const nn::TensorMap start = agent_->AllTensors();
  for (uint64_t u = 0; u < kPeriod; ++u) ASSERT_TRUE(Update(agent_.get(), u).finite);
  const nn::TensorMap after = agent_->AllTensors();
  EXPECT_EQ(after.at("encoder.conv0.weight").data, after.at("model.encoder.conv0.weight").data);
  EXPECT_EQ(after.at("actor.trunk.weight").data, after.at("model.trunk.weight").data);
  EXPECT_EQ(after.at("held.heads.weight").data, after.at("model.heads.weight").data);
  // The held networks had not changed before.
  EXPECT_EQ(after.at("target.encoder.conv0.weight").data, start.at("encoder.conv0.weight").data);
  EXPECT_EQ(after.at("target.joint0.weight").data, start.at("held.joint0.weight").data);
  EXPECT_EQ(after.at("target.mlp.layer0.weight").data, after.at("actor.mlp.layer0.weight").data);
  EXPECT_EQ(after.at("target.q2.output.weight").data, after.at("critic.q2.output.weight").data);
}

TEST_F(MrqAgentTest, AnUpdateThatIsNotFiniteChangesNothing) {
  ASSERT_TRUE(Update(agent_.get(), 1).finite);
  const nn::TensorMap before = agent_->AllTensors();
  const RandomBatch batch = Batch(2);
  batch.View().steps[1].reward[2] = std::nanf("");
  EXPECT_FALSE(agent_->Update(batch.View()).finite);
  EXPECT_THAT(Differences(before, agent_->AllTensors()), IsEmpty());
  EXPECT_EQ(agent_->updates(), 1u);
}

TEST_F(MrqAgentTest, ARestoredAgentContinuesExactly) {
  for (uint64_t u = 0; u < 3; ++u) ASSERT_TRUE(Update(agent_.get(), u).finite);
  const std::unique_ptr<Agent> other = Make();
  other->Restore(agent_->AllTensors(), "test");
  for (uint64_t u = 3; u < 6; ++u) {
    ASSERT_TRUE(Update(agent_.get(), u).finite);
    ASSERT_TRUE(Update(other.get(), u).finite);
  }
  EXPECT_THAT(Differences(agent_->AllTensors(), other->AllTensors()), IsEmpty());
}

TEST_F(MrqAgentTest, ActorsLoadThePolicy) {
  for (const bool pixels : {true, false}) {
    if (!pixels) {
      spec_.cameras.clear();
      spec_.channels = spec_.height = spec_.width = 0;
      config_.network.state_hidden = {10, 8};
      agent_ = Make();
    }
    nn::Policy policy(config_.network, spec_, nn::Precision::kF32, config_.learner.batch);
    policy.Load(agent_->PolicyTensors(), "agent");
    const RandomBatch batch = Batch(3);
    const auto output = policy.Forward(config_.learner.batch, batch.View().obs_frames.data(),
                                       batch.View().obs_vector.data());
    // The mean square of the outputs before tanh is what a penalty adds to the actor's loss.
    double squares = 0;
    for (const float mean : output.mean) squares += double{mean} * mean;
    squares /= double(output.mean.size());
    const double without = Get(Make()->Update(batch.View()), kActorLoss);
    config_.learner.mean_penalty = 1;
    const double with = Get(Make()->Update(batch.View()), kActorLoss);
    config_.learner.mean_penalty = 0;
    EXPECT_NEAR(with - without, squares, 1e-5);
    EXPECT_GT(squares, 1e-3);
  }
}

// Compares the gradient of the model's loss with differences along random directions of all its
// parameters: an error in one layer changes them all.
TEST_F(MrqAgentTest, TheModelsGradientPassesThroughAllStepsAndTheEncoder) {
  const nn::TensorMap start = Perturbed(agent_->AllTensors(), "model.");
  const RandomBatch batch = Batch(4);
  agent_->Restore(start, "test");
  ASSERT_TRUE(agent_->Update(batch.View()).finite);
  const nn::TensorMap after = agent_->AllTensors();
  for (const std::string part : {"model.encoder.conv0", "model.encoder", "model.trunk",
                                 "model.action", "model.joint", "model.heads"}) {
    Random random(9);
    double slope = 0;
    std::array<nn::TensorMap, 2> moved{start, start};
    constexpr float kStep = 3e-4f;
    for (const auto& [name, tensor] : start) {
      if (!name.starts_with(part)) continue;
      std::vector<float> values = Floats(start, name), gradient = Floats(after, "adam.m." + name);
      std::vector<float> above = values, below = values;
      for (size_t i = 0; i < values.size(); ++i) {
        const auto along = float(random.Normal());
        above[i] += kStep * along;
        below[i] -= kStep * along;
        slope += double{along} * gradient[i] / 0.1;
      }
      std::memcpy(moved[0].at(name).data.data(), above.data(), above.size() * sizeof(float));
      std::memcpy(moved[1].at(name).data.data(), below.data(), below.size() * sizeof(float));
    }
    std::array<double, 2> losses{};
    for (size_t i = 0; i < 2; ++i) {
      agent_->Restore(moved[i], "test");
      losses[i] = Get(agent_->Update(batch.View()), kModelLoss);
    }
    const double difference = (losses[0] - losses[1]) / (2 * double{kStep});
    EXPECT_NEAR(slope, difference, 0.02 * std::abs(difference) + 1e-3) << part;
    EXPECT_GT(std::abs(difference), 0.02) << part;
  }
}

// The reward is -(a - s / 2)^2 and every step is the last one.
TEST(MrqLearnsTest, ABanditsBestActions) {
  ObservationSpec spec;
  spec.task = "bandit";
  spec.blocks = {{"state", 2}};
  spec.action_size = 1;
  Config config;
  config.learner.algorithm = "mrq";
  config.learner.batch = 64;
  config.learner.learning_rate = config.mrq.encoder_learning_rate = 3e-3;
  config.mrq.horizon = 1;
  config.mrq.period = 20;
  config.network.state_hidden = {32, 32};
  config.network.hidden = {32, 32};
  const std::unique_ptr<Agent> agent = MakeAgent(config, spec, nn::Precision::kF32);
  Random random(1);
  for (uint64_t u = 0; u < 600; ++u) {
    const RandomBatch batch(spec, BatchOptions{.batch = config.learner.batch, .horizon = 1}, u);
    const BatchView view = batch.View();
    for (size_t b = 0; b < view.rows(); ++b) {
      view.obs_vector[2 * b] = float(random.Uniform(-1, 1));
      const float error = view.action[b] - view.obs_vector[2 * b] / 2;
      view.reward[b] = view.steps[0].reward[b] = -error * error;
      view.bootstrap[b] = 0;
      view.steps[0].action[b] = view.action[b];
      view.steps[0].terminated[b] = 1;
    }
    ASSERT_TRUE(agent->Update(view).finite);
  }
  nn::Policy policy(config.network, spec, nn::Precision::kF32, 1);
  policy.Load(agent->PolicyTensors(), "agent");
  float error = 0;
  for (int i = 0; i < 41; ++i) {
    const float state[2] = {float(i - 20) / 20, 0.f};
    error += std::abs(std::tanh(policy.Forward(1, nullptr, state).mean[0]) - state[0] / 2) / 41;
  }
  EXPECT_LT(error, 0.1) << "a policy that ignores the state has 0.25";
}

TEST(RewardScalesTest, AreMeansOfPeriods) {
  ObservationSpec spec;
  spec.blocks = {{"state", 1}};
  spec.action_size = 1;
  const RandomBatch batch(spec, BatchOptions{.batch = 2, .horizon = 1}, 1);
  const auto add = [&](RewardScales* scales, float first, float second) {
    batch.View().steps[0].reward[0] = first;
    batch.View().steps[0].reward[1] = second;
    scales->Add(batch.View());
  };
  RewardScales scales;
  scales.Advance();
  EXPECT_EQ(scales.critic(), 1);
  add(&scales, -2, 4);
  add(&scales, 1, 1);
  scales.Advance();
  EXPECT_EQ(scales.critic(), 2);
  EXPECT_EQ(scales.target(), 1);
  add(&scales, 0, 0);
  nn::TensorMap tensors;
  scales.Export(&tensors);
  RewardScales other;
  other.Import(tensors, "test");
  other.Advance();
  EXPECT_EQ(other.critic(), 2) << "rewards that are all 0 give no scale";
  EXPECT_EQ(other.target(), 2);
}

}  // namespace
}  // namespace shoal::learner
