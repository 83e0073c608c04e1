// SPDX-License-Identifier: Apache-2.0
// Compares losses and gradients of MR.Q with the published code for equal weights and batches.
// tests/comparison/mrq_updates.py recorded them. Its layer norms have no weights; Shoal's have, but
// they start as those without.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "learner/agent/mrq/mrq_agent.h"
#include "tests/learner/agent/sb3_recording.h"

namespace shoal::learner {
namespace {

class MrqUpdatesTest : public testing::Test {
 protected:
  static constexpr int kRows = 8, kHorizon = 3;

  MrqUpdatesTest() : recording_("mrq/updates") {
    config_.learner.algorithm = "mrq";
    config_.learner.batch = kRows;
    config_.learner.discount = 0.99;
    // The actor's loss follows the critic's step, which must not change the critic here.
    config_.learner.learning_rate = config_.mrq.encoder_learning_rate = 1e-12;
    config_.learner.mean_penalty = 1e-2;
    config_.mrq.horizon = kHorizon;
    config_.mrq.target_noise = 0;
    config_.network.state_hidden = {20, 20, 24};
    config_.network.hidden = {20, 20};
    config_.replay.n_step = 3;
    config_.replay.priorities = "lap";
    spec_.task = "test";
    spec_.blocks = {{"observation", 11}};
    spec_.action_size = 3;
    AddModel("model", "model.mlp", "model");
    AddModel("held", "actor.mlp", "held");
    AddModel("target", "target.mlp", "target");
    AddHeads("actor.policy.l", "critic", "actor.mlp", "critic");
    AddHeads("target_actor.policy.l", "target_critic", "target.mlp", "target");
    agent_ = MakeAgent(config_, spec_, nn::Precision::kF32);
    agent_->Restore(recording_.WithTheirWeights(agent_->AllTensors()), "test");
  }

  void AddModel(const std::string& theirs, const std::string& state, const std::string& model) {
    for (const int i : {0, 1, 2}) {
      recording_.Add(fmt::format("{}.layer{}", state, i),
                     fmt::format("{}.zs_mlp.l{}", theirs, i + 1));
    }
    recording_.Add(model + ".action", theirs + ".za");
    recording_.Add(model + ".joint0", theirs + ".zsa.l1");
    recording_.Add(model + ".joint1", theirs + ".zsa.l2");
    recording_.Add(model + ".joint.output", theirs + ".zsa.l3");
    recording_.Add(model + ".heads", theirs + ".model");
  }

  void AddHeads(const std::string& their_policy, const std::string& their_critic,
                const std::string& policy, const std::string& critic) {
    recording_.Add(policy + ".layer3", their_policy + "1");
    recording_.Add(policy + ".layer4", their_policy + "2");
    recording_.Add(policy + ".output", their_policy + "3");
    for (const char* q : {"q1", "q2"}) {
      for (const int i : {0, 1, 2}) {
        recording_.Add(fmt::format("{}.{}.layer{}", critic, q, i),
                       fmt::format("{}.{}.q1.l{}", their_critic, q, i + 1));
      }
      recording_.Add(fmt::format("{}.{}.output", critic, q),
                     fmt::format("{}.{}.q2", their_critic, q));
    }
  }

  // Row `update` ends with step 1, row `update` + 3 with step 2.
  void Fill(int update, const BatchView& batch) const {
    FillSb3Batch(update, batch);
    for (float& bootstrap : batch.bootstrap) bootstrap *= 0.99f * 0.99f;
    for (size_t h = 0; h < batch.steps.size(); ++h) {
      const std::string at = fmt::format("update{}.step{}.", update, h + 1);
      const StepView& step = batch.steps[h];
      FillSymmetric(at + "next_obs", 1.5, step.next_vector);
      FillSymmetric(at + "action", 1.0, step.action);
      FillSymmetric(at + "reward", 2.0, step.reward);
      for (size_t b = 0; b < size_t(kRows); ++b) {
        const size_t end = b == size_t(update)               ? 0
                           : b == size_t(update + 3) % kRows ? 1
                                                             : size_t(kHorizon);
        step.terminated[b] = h == end ? 1 : 0;
        step.present[b] = h <= end ? 1 : 0;
      }
    }
  }

  Sb3Recording recording_;
  ObservationSpec spec_;
  Config config_;
  std::unique_ptr<Agent> agent_;
};

TEST_F(MrqUpdatesTest, LossesAndGradientsAreThoseOfThePublishedCode) {
  const nn::TensorMap start = agent_->AllTensors();
  const RandomBatch batch(spec_, BatchOptions{.batch = kRows, .n_step = 3, .horizon = kHorizon}, 1);
  for (int update = 0; update < Sb3Recording::kUpdates; ++update) {
    SCOPED_TRACE(update);
    agent_->Restore(start, "test");
    Fill(update, batch.View());
    const UpdateOutcome outcome = agent_->Update(batch.View());
    ASSERT_TRUE(outcome.finite);
    const float model_loss = recording_.Get(update, "model_loss")[0];
    EXPECT_NEAR(Get(outcome, kModelLoss), model_loss, 1e-5 * model_loss);
    EXPECT_NEAR(Get(outcome, kTargetMean), recording_.Mean(update, "target"), 1e-5);
    // The published loss is the mean over two critics of half of Eq. 34's function.
    const float critic_loss = 4 * recording_.Get(update, "critic_loss")[0];
    EXPECT_NEAR(Get(outcome, kCriticLoss), critic_loss, 1e-5 * critic_loss);
    EXPECT_NEAR(Get(outcome, kActorLoss), recording_.Get(update, "actor_loss")[0], 1e-5);
    const auto factor = [](const std::string& layer) {
      return layer.starts_with("critic") ? 4 : 1;
    };
    EXPECT_EQ(recording_.ExpectGradients(update, start, agent_->AllTensors(), factor), 16 + 16 + 6);
  }
}

}  // namespace
}  // namespace shoal::learner
