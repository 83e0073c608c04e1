// SPDX-License-Identifier: Apache-2.0
// Compares four updates of TD3 and DDPG with Stable-Baselines3 for equal weights and batches. The
// target's action has no noise, because the two programs draw different random numbers.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "common/config/config_io.h"
#include "learner/agent/deterministic/deterministic_agent.h"
#include "learner/engine/cpu_engine.h"
#include "tests/learner/agent/sb3_recording.h"

namespace shoal::learner {
namespace {

constexpr int kBatch = 8, kActions = 3, kVector = 11;

struct RecordedUpdates {
  const char* name;
  DeterministicOptions options;
  int period;  // of actor and targets
};

void PrintTo(const RecordedUpdates& each, std::ostream* out) { *out << each.name; }

class Sb3UpdatesTest : public testing::TestWithParam<RecordedUpdates> {
 protected:
  Sb3UpdatesTest() : recording_(std::string("sb3/") + GetParam().name) {
    spec_.task = "test";
    spec_.blocks = {{"observation", kVector}};
    spec_.action_size = kActions;
    config_.learner.batch = kBatch;
    config_.learner.learning_rate = 1e-3;
    config_.learner.discount = 0.99;
    config_.learner.reward_scale = 1;
    config_.learner.tau = 0.005;
    config_.learner.actor_period = config_.learner.target_period = GetParam().period;
    config_.network.hidden = {20, 16};
    config_.network.layer_norm = false;
    recording_.AddMlp("actor.mlp", "actor.mu");
    recording_.AddMlp("target_actor.mlp", "actor_target.mu");
    for (int i = 0; i < GetParam().options.critics; ++i) {
      recording_.AddMlp("critic.q" + std::to_string(i + 1), "critic.qf" + std::to_string(i));
      recording_.AddMlp("target.q" + std::to_string(i + 1), "critic_target.qf" + std::to_string(i));
    }
    agent_ = MakeDeterministicAgent(config_, spec_, GetParam().options, &engine_);
    agent_->Restore(recording_.WithTheirWeights(agent_->AllTensors()), "test");
  }

  Sb3Recording recording_;
  ObservationSpec spec_;
  Config config_;
  nn::Replica alone_;
  CpuEngine engine_{nn::Precision::kF32, kBatch, &alone_};
  std::unique_ptr<Agent> agent_;
};

TEST_P(Sb3UpdatesTest, LossesGradientsParametersAndTargetsAreTheirs) {
  const RandomBatch batch(spec_, kBatch, 1);
  for (int update = 0; update < Sb3Recording::kUpdates; ++update) {
    SCOPED_TRACE(update);
    FillSb3Batch(update, batch.View());
    const nn::TensorMap before = agent_->AllTensors();
    const UpdateOutcome outcome = agent_->Update(batch.View());
    ASSERT_TRUE(outcome.finite);
    EXPECT_NEAR(Get(outcome, kTargetMean), recording_.Mean(update, "target"), 1e-5);
    const float critic_loss = recording_.Get(update, "critic_loss")[0];
    EXPECT_NEAR(Get(outcome, kCriticLoss), critic_loss, 1e-5 * std::abs(critic_loss));
    ASSERT_EQ(outcome.figures.Get(kActorLoss).has_value(), recording_.Has(update, "actor_loss"));
    if (recording_.Has(update, "actor_loss")) {
      EXPECT_NEAR(Get(outcome, kActorLoss), recording_.Get(update, "actor_loss")[0], 1e-5);
    }
    const nn::TensorMap after = agent_->AllTensors();
    EXPECT_GE(recording_.ExpectGradients(update, before, after, [](auto&) { return 1; }), 6);
    recording_.ExpectParameters(update, after);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Sb3UpdatesTest,
                         testing::Values(RecordedUpdates{"td3", {.critics = 2}, 2},
                                         RecordedUpdates{"ddpg", {.critics = 1}, 1}),
                         [](const auto& each) { return std::string(each.param.name); });

// The preset's networks and rates, in small: SAC of CnnPolicy.
class Sb3NatureTest : public testing::Test {
 protected:
  Sb3NatureTest() : recording_("sb3/sac") {
    config_ = LoadPreset("sb3-nature");
    config_.seed = 7;
    config_.learner.batch = kBatch;
    config_.network.features = 24;
    config_.network.hidden = {20, 16};
    spec_.task = "test";
    spec_.cameras = {"gymnasium"};
    spec_.channels = 3;
    spec_.height = spec_.width = 36;
    spec_.action_size = kActions;
    for (const auto& [ours, theirs] :
         {std::pair("encoder", "actor"), std::pair("critic.encoder", "critic"),
          std::pair("target.encoder", "critic_target")}) {
      for (const int i : {0, 1, 2}) {
        recording_.Add(fmt::format("{}.conv{}", ours, i),
                       fmt::format("{}.features_extractor.cnn.{}", theirs, 2 * i));
      }
    }
    recording_.Add("actor.trunk", "actor.features_extractor.linear.0");
    recording_.Add("critic.trunk", "critic.features_extractor.linear.0");
    recording_.Add("target.trunk", "critic_target.features_extractor.linear.0");
    recording_.Add("actor.mlp.layer0", "actor.latent_pi.0");
    recording_.Add("actor.mlp.layer1", "actor.latent_pi.2");
    recording_.Add("actor.mlp.output", "actor.mu", 0, 2, 0.1);
    recording_.Add("actor.mlp.output", "actor.log_std", 1, 2, 0.1);
    for (const int i : {0, 1}) {
      recording_.AddMlp(fmt::format("critic.q{}", i + 1), fmt::format("critic.qf{}", i));
      recording_.AddMlp(fmt::format("target.q{}", i + 1), fmt::format("critic_target.qf{}", i));
    }
    agent_ = MakeAgent(config_, spec_, nn::Precision::kF32);
    agent_->Restore(recording_.WithTheirWeights(agent_->AllTensors()), "test");
  }

  Sb3Recording recording_;
  ObservationSpec spec_;
  Config config_;
  std::unique_ptr<Agent> agent_;
};

TEST_F(Sb3NatureTest, LossesGradientsParametersAndTargetsAreTheirs) {
  const RandomBatch batch(spec_, kBatch, 1);
  for (int update = 0; update < Sb3Recording::kUpdates; ++update) {
    SCOPED_TRACE(update);
    FillSb3Batch(update, batch.View());
    const nn::TensorMap before = agent_->AllTensors();
    const UpdateOutcome outcome = agent_->Update(batch.View());
    ASSERT_TRUE(outcome.finite);
    EXPECT_NEAR(Get(outcome, kTargetMean), recording_.Mean(update, "target"), 1e-5);
    // Their critic's loss is half of ours: Adam does not mind.
    const float critic_loss = 2 * recording_.Get(update, "critic_loss")[0];
    EXPECT_NEAR(Get(outcome, kCriticLoss), critic_loss, 1e-5 * std::abs(critic_loss));
    EXPECT_NEAR(Get(outcome, kActorLoss), recording_.Get(update, "actor_loss")[0], 1e-5);
    const nn::TensorMap after = agent_->AllTensors();
    const auto factor = [](const std::string& layer) {
      return layer.starts_with("critic") ? 2 : 1;
    };
    EXPECT_EQ(recording_.ExpectGradients(update, before, after, factor), 16 + 20);
    recording_.ExpectParameters(update, after);
    EXPECT_NEAR(Floats(after, "temperature.log")[0],
                recording_.Get(update, "after.log_ent_coef")[0], 1e-6);
  }
}

}  // namespace
}  // namespace shoal::learner
