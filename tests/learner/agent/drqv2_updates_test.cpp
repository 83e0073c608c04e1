// SPDX-License-Identifier: Apache-2.0
// Compares four updates of DrQ-v2 with PyTorch for equal weights, batches and noise.
// tests/comparison/drqv2_updates.py recorded the updates.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "common/config/config_io.h"
#include "tests/learner/agent/sb3_recording.h"

namespace shoal::learner {
namespace {

// The networks and rates of a preset, in small.
class Drqv2UpdatesTest : public testing::Test {
 protected:
  static constexpr int kRows = 8;
  static constexpr uint64_t kStepsOfUpdate = 400;  // env steps between two updates

  Drqv2UpdatesTest() : recording_("drqv2/updates") {
    config_ = LoadPreset("dmc-cheetah_run-drqv2");
    config_.seed = 7;
    config_.drqv2.noise = {.start = 1, .end = 0.1, .env_steps = 1000};
    config_.learner.batch = kRows;
    config_.learner.learning_rate = 1e-3;
    config_.network.features = 24;
    config_.network.hidden = {20, 16};
    spec_.task = "test";
    spec_.cameras = {"side"};
    spec_.channels = 3;
    spec_.stack = 3;
    spec_.height = spec_.width = 17;
    spec_.action_size = 3;
    for (const int i : {0, 1, 2, 3}) {
      recording_.Add(fmt::format("encoder.conv{}", i), fmt::format("encoder.{}", 2 * i));
    }
    for (const char* head : {"actor", "critic", "target"}) {
      recording_.Add(fmt::format("{}.trunk", head), fmt::format("{}.trunk.0", head));
      recording_.Add(fmt::format("{}.trunk.norm", head), fmt::format("{}.trunk.1", head));
    }
    recording_.AddMlp("actor.mlp", "actor.policy");
    for (const char* mlp : {"critic.q1", "critic.q2", "target.q1", "target.q2"}) {
      recording_.AddMlp(mlp, mlp);
    }
    agent_ = MakeAgent(config_, spec_, nn::Precision::kF32);
    agent_->Restore(recording_.WithTheirWeights(agent_->AllTensors()), "test");
  }

  Sb3Recording recording_;
  ObservationSpec spec_;
  Config config_;
  std::unique_ptr<Agent> agent_;
};

TEST_F(Drqv2UpdatesTest, LossesGradientsParametersAndTargetsAreThoseOfPyTorch) {
  const RandomBatch batch(spec_, kRows, 1);
  for (int update = 0; update < Sb3Recording::kUpdates; ++update) {
    SCOPED_TRACE(update);
    BatchView view = batch.View();
    FillSb3Batch(update, view);
    view.stored_steps = kStepsOfUpdate * uint64_t(update);
    const nn::TensorMap before = agent_->AllTensors();
    const UpdateOutcome outcome = agent_->Update(view);
    ASSERT_TRUE(outcome.finite);
    EXPECT_NEAR(Get(outcome, kTargetMean), recording_.Mean(update, "target"), 1e-5);
    const float critic_loss = recording_.Get(update, "critic_loss")[0];
    EXPECT_NEAR(Get(outcome, kCriticLoss), critic_loss, 1e-5 * std::abs(critic_loss));
    EXPECT_NEAR(Get(outcome, kActorLoss), recording_.Get(update, "actor_loss")[0], 1e-5);
    const nn::TensorMap after = agent_->AllTensors();
    EXPECT_EQ(recording_.ExpectGradients(update, before, after, [](auto&) { return 1; }),
              8 + 10 + 16);
    recording_.ExpectParameters(update, after);
  }
}

}  // namespace
}  // namespace shoal::learner
