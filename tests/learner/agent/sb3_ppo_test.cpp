// SPDX-License-Identifier: Apache-2.0
// Compares two epochs of PPO with Stable-Baselines3 for equal weights and rollouts.
// tests/comparison/sb3_ppo.py made the recordings and describes the files.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "common/base/aligned_bytes.h"
#include "common/base/files.h"
#include "learner/agent/ppo/advantages.h"
#include "learner/agent/ppo/ppo_agent.h"
#include "learner/agent/replicated_agent.h"
#include "tests/learner/agent/agent_fixture.h"
#include "tests/support/paths.h"
#include "tests/support/shared_numbers.h"

namespace shoal::learner {
namespace {

constexpr int kSteps = 8, kEnvs = 2, kRows = kSteps * kEnvs, kPpoBatch = 4, kPpoActions = 3,
              kPpoVector = 5;

// Parameter names of ours and theirs.
const std::map<std::string, std::string> kNames{{"actor.mlp.layer0", "mlp_extractor.policy_net.0"},
                                                {"actor.mlp.layer1", "mlp_extractor.policy_net.2"},
                                                {"actor.mlp.output", "action_net"},
                                                {"value.mlp.layer0", "mlp_extractor.value_net.0"},
                                                {"value.mlp.layer1", "mlp_extractor.value_net.2"},
                                                {"value.mlp.output", "value_net"}};

struct RecordedPpo {
  const char* name;
  double clip, value_clip, entropy_weight;
};

void PrintTo(const RecordedPpo& each, std::ostream* out) { *out << each.name; }

class Sb3PpoTest : public testing::TestWithParam<RecordedPpo> {
 protected:
  Sb3PpoTest()
      : recorded_(nn::ReadSafetensors(
            ReadFile(GoldenPath(std::string("sb3/") + GetParam().name + ".safetensors")),
            GetParam().name)) {
    spec_.task = "test";
    spec_.blocks = {{"observation", kPpoVector}};
    spec_.action_size = kPpoActions;
    spec_.drawn_actions = true;
    config_.learner.algorithm = "ppo";
    config_.learner.batch = kPpoBatch;
    config_.learner.learning_rate = 1e-3;
    config_.learner.max_grad_norm = 0.5;
    config_.learner.discount = 0.9;
    config_.ppo.gae_lambda = 0.8;
    config_.ppo.epochs = 2;
    config_.ppo.clip = Schedule::Constant(GetParam().clip);
    config_.ppo.value_clip = GetParam().value_clip;
    config_.ppo.entropy_weight = GetParam().entropy_weight;
    config_.network.hidden = {7, 6};
    config_.network.layer_norm = false;
    config_.network.activation = "tanh";
    schema_.emplace(spec_, BatchOptions{.batch = kRows, .rollout = true});
    memory_ = AlignedBytes(schema_->total_bytes());
    std::memset(memory_.data(), 0, schema_->total_bytes());
    agent_ = Make([this](int, Random*) {
      const std::vector<float> rows = Recorded("permutation." + std::to_string(epoch_++));
      // Theirs count row by row of the flattened buffer: environment by environment, as ours.
      return std::vector<int>(rows.begin(), rows.end());
    });
    agent_->Restore(WithTheirWeights(agent_->AllTensors()), "test");
    FillRollout();
  }

  std::unique_ptr<Agent> Make(const RowOrder& order) const {
    return MakeReplicatedAgent(config_, nn::Precision::kF32, 1, [&](Engine* engine) {
      return MakePpoAgent(config_, spec_, engine, order);
    });
  }

  std::vector<float> Recorded(const std::string& name) const { return Floats(recorded_, name); }

  static std::string Theirs(const std::string& ours) {
    if (ours == "actor.log_std") return "log_std";
    const size_t dot = ours.rfind('.');
    return kNames.at(ours.substr(0, dot)) + ours.substr(dot);
  }

  nn::TensorMap WithTheirWeights(nn::TensorMap tensors) const {
    for (auto& [name, tensor] : tensors) {
      const size_t dot = name.rfind('.');
      const bool log_std = name == "actor.log_std";
      if (!log_std && !kNames.contains(name.substr(0, dot))) continue;
      double scale = 0.3;
      if (!log_std) {
        const auto fan_in = double(tensors.at(name.substr(0, dot) + ".weight").shape[1]);
        scale = std::sqrt((name.ends_with("weight") ? 6 : 1) / fan_in);
      }
      FillSymmetric(Theirs(name), scale,
                    std::span(reinterpret_cast<float*>(tensor.data.data()),
                              tensor.data.size() / sizeof(float)));
    }
    return tensors;
  }

  // Theirs are (steps, envs, ...), ours environment by environment.
  void FillRollout() {
    const BatchView batch = View();
    std::vector<float> obs(size_t(kSteps + 1) * kEnvs * kPpoVector), reward(kRows),
        final(kPpoVector);
    std::vector<float> drawn(size_t(kRows) * kPpoActions);
    FillSymmetric("obs", 1.5, obs);
    FillSymmetric("drawn", 1.5, drawn);
    FillSymmetric("reward", 2.0, reward);
    FillSymmetric("final", 1.5, final);
    const std::vector<float> log_prob = Recorded("log_prob");
    for (int e = 0; e < kEnvs; ++e) {
      for (int t = 0; t < kSteps; ++t) {
        const size_t row = size_t(e * kSteps + t), theirs = size_t(t * kEnvs + e);
        std::copy_n(obs.data() + theirs * kPpoVector, kPpoVector,
                    &batch.obs_vector[row * kPpoVector]);
        std::copy_n(drawn.data() + theirs * kPpoActions, kPpoActions,
                    &batch.drawn_action[row * kPpoActions]);
        batch.reward[row] = reward[theirs];
        batch.log_prob[row] = log_prob[row];
        const bool terminated = e == 0 && t == 2, truncated = e == 1 && t == 4;
        batch.bootstrap[row] = terminated ? 0 : 1;
        batch.ends[row] = terminated || truncated ? 1 : 0;
        batch.continues[row] = terminated || truncated || t + 1 == kSteps ? 0 : 1;
        const float* next = obs.data() + (theirs + kEnvs) * kPpoVector;
        std::copy_n(truncated ? final.data() : next, kPpoVector,
                    &batch.next_obs_vector[row * kPpoVector]);
      }
    }
  }

  BatchView View() const { return schema_->View(memory_.data()); }

  const nn::TensorMap recorded_;
  ObservationSpec spec_;
  Config config_;
  std::optional<BatchSchema> schema_;
  AlignedBytes memory_;
  std::unique_ptr<Agent> agent_;
  int epoch_ = 0;
};

TEST_P(Sb3PpoTest, AdvantagesAreTheirs) {
  const BatchView batch = View();
  const std::vector<float> value = Recorded("value");
  std::vector<float> next_value(kRows), advantage(kRows), target(kRows);
  // The value after the rollout, and the time limit, follow from the recorded advantages.
  const std::vector<float> theirs = Recorded("advantage");
  for (size_t t = 0; t < kRows; ++t) {
    next_value[t] = batch.continues[t] != 0 ? value[t + 1]
                                            : float((theirs[t] - batch.reward[t] + value[t]) / 0.9);
  }
  Advantages({batch.reward, batch.bootstrap, batch.continues, value, next_value, 0.9, 0.8},
             advantage, target);
  const std::vector<float> targets = Recorded("target");
  for (size_t t = 0; t < kRows; ++t) {
    EXPECT_NEAR(advantage[t], theirs[t], 2e-6) << t;
    EXPECT_NEAR(target[t], targets[t], 2e-6) << t;
  }
}

// Losses, gradients and every step of both epochs: parameters agree only if all of them do.
TEST_P(Sb3PpoTest, TwoEpochsEndWithTheirParameters) {
  const UpdateOutcome outcome = agent_->Update(View());
  ASSERT_TRUE(outcome.finite);
  EXPECT_EQ(Get(outcome, kMinibatches), 2 * kRows / kPpoBatch);
  EXPECT_NEAR(Get(outcome, kActorLoss), Recorded("policy_loss")[0], 2e-6);
  EXPECT_NEAR(Get(outcome, kValueLoss), Recorded("value_loss")[0], 2e-5);
  EXPECT_NEAR(Get(outcome, kClipFraction), Recorded("clip_fraction")[0], 1e-6);
  EXPECT_GT(Get(outcome, kClipFraction), 0) << "no ratio is clipped: the case is too easy";
  const std::string last = std::to_string(2 * kRows / kPpoBatch - 1) + ".after.";
  const nn::TensorMap tensors = agent_->AllTensors();
  int compared = 0;
  for (const auto& [name, tensor] : tensors) {
    if (name != "actor.log_std" && !kNames.contains(name.substr(0, name.rfind('.')))) continue;
    const std::vector<float> ours = Floats(tensors, name), theirs = Recorded(last + Theirs(name));
    ASSERT_EQ(ours.size(), theirs.size()) << name;
    for (size_t i = 0; i < ours.size(); ++i) EXPECT_NEAR(ours[i], theirs[i], 5e-6) << name << i;
    ++compared;
  }
  EXPECT_EQ(compared, 13);
}

// After one minibatch Adam's first moment is a tenth of the gradient that was stepped by.
TEST_P(Sb3PpoTest, GradientsAreTheirs) {
  config_.ppo.epochs = 1;
  const std::vector<float> order = Recorded("permutation.0");
  agent_ = Make(
      [&](int, Random*) { return std::vector<int>(order.begin(), order.begin() + kPpoBatch); });
  agent_->Restore(WithTheirWeights(agent_->AllTensors()), "test");
  ASSERT_TRUE(agent_->Update(View()).finite);
  const nn::TensorMap tensors = agent_->AllTensors();
  for (const auto& [ours, theirs] : kNames) {
    for (const char* kind : {".weight", ".bias"}) {
      const std::vector<float> moment = Floats(tensors, "adam.m." + ours + kind);
      const std::vector<float> gradient = Recorded("0.gradient." + theirs + kind);
      ASSERT_EQ(moment.size(), gradient.size());
      for (size_t i = 0; i < moment.size(); ++i) {
        EXPECT_NEAR(moment[i] / 0.1, gradient[i], 2e-6) << ours << kind << i;
      }
    }
  }
  const std::vector<float> moment = Floats(tensors, "adam.m.actor.log_std");
  const std::vector<float> gradient = Recorded("0.gradient.log_std");
  for (size_t i = 0; i < moment.size(); ++i) EXPECT_NEAR(moment[i] / 0.1, gradient[i], 2e-6) << i;
}

INSTANTIATE_TEST_SUITE_P(Recorded, Sb3PpoTest,
                         testing::Values(RecordedPpo{"ppo", 0.2, 0, 0},
                                         RecordedPpo{"ppo_clipped", 0.1, 0.05, 0.01}));

}  // namespace
}  // namespace shoal::learner
