// SPDX-License-Identifier: Apache-2.0
// PPO with a device in host memory, beside PPO with the CPU's engine, the same rollouts and the
// same order of rows. An update of a rollout is a sequence of minibatches.
#include <gmock/gmock.h>

#include <vector>

#include "learner/agent/ppo/ppo_agent.h"
#include "tests/learner/device/device_fixture.h"

namespace shoal::learner::device {
namespace {

using testing::IsEmpty;

class DevicePpoTest : public testing::TestWithParam<AgentCase> {
 protected:
  static constexpr int kEpochs = 4, kBatches = 5;  // 20 minibatches of a rollout

  DevicePpoTest() {
    config_.learner.algorithm = "ppo";
    config_.learner.max_grad_norm = 0.5;
    config_.learner.normalise_vectors = true;
    config_.learner.rate_factor = Schedule{.start = 1, .end = 0.5, .env_steps = 300};
    config_.ppo.epochs = kEpochs;
    config_.ppo.clip = Schedule{.start = 0.3, .end = 0.2, .env_steps = 300};
    config_.ppo.normalise_rewards = true;
    spec_.drawn_actions = true;
    GetParam().set(&config_, &spec_);
  }

  // A rollout with log-probabilities near those of an untrained policy, whose means are about 0
  // and deviations about 1. It has two rows beyond whole minibatches.
  RandomBatch Rollout(uint64_t key) const {
    const int rows = kBatches * config_.learner.batch + 2;
    RandomBatch rollout(spec_, rows, key, /*rollout=*/true);
    const BatchView view = rollout.View();
    for (size_t b = 0; b < view.rows(); ++b) {
      const std::span<const float> u = view.drawn_action.subspan(2 * b, 2);
      view.log_prob[b] =
          -1.837877f - (u[0] * u[0] + u[1] * u[1]) / 2 + 0.1f * (view.log_prob[b] + 2.5f);
    }
    return rollout;
  }

  void ExpectLikeTheCpu(nn::Precision precision, double first, double later, double moments) {
    OnCpu cpu(config_, spec_, nn::Precision::kF32);
    OnDevice device(config_, spec_, precision);
    ExpectNear(device.agent->AllTensors(), cpu.agent->AllTensors(), 1e-12, 1e-12);
    const uint64_t rollouts = GetParam().updates / (kEpochs * kBatches);
    for (uint64_t u = 0; u < rollouts; ++u) {
      const RandomBatch rollout = Rollout(u);
      const UpdateOutcome expected = cpu.agent->Update(rollout.View());
      const UpdateOutcome outcome = device.agent->Update(rollout.View());
      ASSERT_TRUE(expected.finite && outcome.finite) << u;
      ASSERT_EQ(Get(outcome, kMinibatches), Get(expected, kMinibatches)) << u;
      if (u == 0) ExpectFigures(outcome, expected, first);
    }
    ExpectNear(device.agent->AllTensors(), cpu.agent->AllTensors(), later, moments,
               GetParam().without_effect);
    // A pass of the values and a minibatch, each in two landings.
    EXPECT_EQ(device.engine.recorded(), 4);
  }

  Config config_ = SmallConfig();
  ObservationSpec spec_ = SmallSpec();
};

TEST_P(DevicePpoTest, LearnsLikeTheCpuInF32) {
  ExpectLikeTheCpu(nn::Precision::kF32, 1e-4, 1e-3, 1e-2);
}

// Rounding differs from f32 in every minibatch, so the distance grows.
TEST_P(DevicePpoTest, LearnsInBf16LikeTheCpuInF32) {
  ExpectLikeTheCpu(nn::Precision::kBf16, 2e-2, 6e-2, 0);
}

TEST_P(DevicePpoTest, RepeatsItselfBitForBit) {
  HostDevice::Options backward = kPadding;
  backward.order = kernels::HostOrder::kBackward;
  backward.first = Lane::kCopies;
  OnDevice one(config_, spec_, nn::Precision::kBf16);
  OnDevice other(config_, spec_, nn::Precision::kBf16, DeviceEngine::kInFlight, backward);
  for (uint64_t u = 0; u < 3; ++u) {
    const UpdateOutcome some = one.agent->Update(Rollout(u).View());
    const auto known = other.agent->Submit(Rollout(u).View(), [](UpdateStage) {});
    ASSERT_THAT(known, testing::SizeIs(1)) << "PPO waits for each minibatch";
    for (const auto& entry : some.figures.entries()) {
      EXPECT_EQ(Get(known[0], *entry.figure), entry.value) << entry.figure->name;
    }
  }
  EXPECT_THAT(Differences(other.agent->AllTensors(), one.agent->AllTensors()), IsEmpty());
}

// The minibatch that moved the policy too far has no effect, and ends the epochs.
TEST_P(DevicePpoTest, EndsAnUpdateThatMovesThePolicyTooFarLikeTheCpu) {
  config_.ppo.target_kl = 0.02;
  config_.ppo.epochs = 30;
  config_.learner.learning_rate = 1e-2;
  OnCpu cpu(config_, spec_, nn::Precision::kF32);
  OnDevice device(config_, spec_, nn::Precision::kF32);
  const double steps = Get(cpu.agent->Update(Rollout(1).View()), kMinibatches);
  EXPECT_EQ(Get(device.agent->Update(Rollout(1).View()), kMinibatches), steps);
  EXPECT_GT(steps, 0);
  EXPECT_LT(steps, 30 * kBatches) << "choose another target_kl";
  ExpectNear(device.agent->AllTensors(), cpu.agent->AllTensors(), 1e-3, 1e-2,
             GetParam().without_effect);
}

// A rollout that is not finite, or a loss in a minibatch after steps, leaves no trace.
TEST_P(DevicePpoTest, ARolloutThatIsNotFiniteHasNoEffect) {
  OnDevice clean(config_, spec_, nn::Precision::kF32), spoilt(config_, spec_, nn::Precision::kF32);
  constexpr size_t kBad = 3;
  for (const bool in_batch : {true, false}) {
    const uint64_t key = in_batch ? 0 : 1;
    ASSERT_TRUE(clean.agent->Update(Rollout(key).View()).finite);
    ASSERT_TRUE(spoilt.agent->Update(Rollout(key).View()).finite);
    const RandomBatch bad = Rollout(9);
    bad.View().log_prob[kBad] = in_batch ? NAN : -3e38f;
    bad.View().reward[kBad] = -100;  // without a negative advantage, the ratio would be clipped
    const UpdateOutcome outcome = spoilt.agent->Update(bad.View());
    EXPECT_FALSE(outcome.finite);
    if (!in_batch) {
      EXPECT_GT(Get(outcome, kMinibatches), 0) << "choose a row of a later minibatch";
    }
    EXPECT_EQ(spoilt.agent->updates(), clean.agent->updates());
    EXPECT_THAT(Differences(spoilt.agent->AllTensors(), clean.agent->AllTensors()), IsEmpty());
  }
  ASSERT_TRUE(clean.agent->Update(Rollout(2).View()).finite);
  ASSERT_TRUE(spoilt.agent->Update(Rollout(2).View()).finite);
  EXPECT_THAT(Differences(spoilt.agent->AllTensors(), clean.agent->AllTensors()), IsEmpty());
}

TEST_P(DevicePpoTest, CheckpointsMoveBetweenDeviceAndCpu) {
  constexpr auto kF32 = nn::Precision::kF32;
  OnDevice first(config_, spec_, kF32), third(config_, spec_, kF32);
  OnCpu expected(config_, spec_, kF32), second(config_, spec_, kF32);
  first.agent->Update(Rollout(0).View());
  const nn::TensorMap written = first.agent->AllTensors();
  second.agent->Restore(written, "test");
  EXPECT_THAT(Differences(second.agent->AllTensors(), written), IsEmpty());
  second.agent->Update(Rollout(1).View());
  third.agent->Restore(second.agent->AllTensors(), "test");
  EXPECT_THAT(Differences(third.agent->AllTensors(), second.agent->AllTensors()), IsEmpty());
  third.agent->Update(Rollout(2).View());
  for (uint64_t u = 0; u < 3; ++u) expected.agent->Update(Rollout(u).View());
  EXPECT_EQ(third.agent->updates(), 3u);
  ExpectNear(third.agent->AllTensors(), expected.agent->AllTensors(), 1e-3, 1e-2,
             GetParam().without_effect);
}

const AgentCase kPpoCases[] = {
    {"vectors", [](Config*, ObservationSpec* spec) { WithoutPixels(spec); }},
    {"vectors_shared",
     [](Config* config, ObservationSpec* spec) {
       WithoutPixels(spec);
       config->ppo.networks = "shared";
       config->ppo.value_clip = 0.2;
       config->ppo.entropy_weight = 0.01;
       config->ppo.normalise_advantages = false;
       config->network.layer_norm = false;
       config->network.activation = "tanh";
       config->network.initialisation = "orthogonal";
     }},
    {"compact", [](Config*, ObservationSpec*) {}},
    {"compact_shared", [](Config* config, ObservationSpec*) { config->ppo.networks = "shared"; }},
};

INSTANTIATE_TEST_SUITE_P(Of, DevicePpoTest, testing::ValuesIn(kPpoCases),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace shoal::learner::device
