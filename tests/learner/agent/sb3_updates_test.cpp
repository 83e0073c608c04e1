// Four updates of TD3 and DDPG, held to what Stable-Baselines3 computes from the same weights and
// batches: tests/comparison/sb3_updates.py recorded it and says what the files hold. Without noise
// on the target's action: both sides' random numbers are their own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/base/files.h"
#include "learner/agent/deterministic/deterministic_agent.h"
#include "tests/learner/agent/agent_fixture.h"
#include "tests/support/paths.h"
#include "tests/support/shared_numbers.h"

namespace shoal::learner {
namespace {

constexpr int kBatch = 8, kActions = 3, kVector = 11, kUpdates = 4;
constexpr double kFirstMoment = 0.1;  // 1 - b1 of Adam

struct Layer {
  std::string ours, theirs;  // names without ".weight" and ".bias"
};

struct Case {
  const char* name;
  DeterministicOptions options;
  int period;  // of actor and targets
};

void PrintTo(const Case& each, std::ostream* out) { *out << each.name; }

class Sb3UpdatesTest : public testing::TestWithParam<Case> {
 protected:
  Sb3UpdatesTest()
      : recorded_(nn::ReadSafetensors(
            ReadFile(GoldenPath(std::string("sb3/") + GetParam().name + ".safetensors")),
            GetParam().name)) {
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
    AddMlp("actor.mlp", "actor.mu");
    AddMlp("target_actor.mlp", "actor_target.mu");
    for (int i = 0; i < GetParam().options.critics; ++i) {
      AddMlp("critic.q" + std::to_string(i + 1), "critic.qf" + std::to_string(i));
      AddMlp("target.q" + std::to_string(i + 1), "critic_target.qf" + std::to_string(i));
    }
    agent_ = MakeDeterministicAgent(config_, spec_, nn::Precision::kF32, GetParam().options);
    agent_->Restore(WithTheirWeights(agent_->AllTensors()), "test");
  }

  void AddMlp(const std::string& ours, const std::string& theirs) {
    layers_.push_back({ours + ".layer0", theirs + ".0"});
    layers_.push_back({ours + ".layer1", theirs + ".2"});
    layers_.push_back({ours + ".output", theirs + ".4"});
  }

  nn::TensorMap WithTheirWeights(nn::TensorMap tensors) const {
    for (const Layer& layer : layers_) {
      const auto fan_in = double(tensors.at(layer.ours + ".weight").shape[1]);
      for (const char* kind : {".weight", ".bias"}) {
        nn::NamedTensor& tensor = tensors.at(layer.ours + kind);
        const double scale = std::sqrt((std::string(kind) == ".weight" ? 6 : 1) / fan_in);
        FillSymmetric(layer.theirs + kind, scale,
                      std::span(reinterpret_cast<float*>(tensor.data.data()),
                                tensor.data.size() / sizeof(float)));
      }
    }
    return tensors;
  }

  static void Fill(int update, const BatchView& batch) {
    const std::string at = "update" + std::to_string(update) + ".";
    FillSymmetric(at + "obs", 1.5, batch.obs_vector);
    FillSymmetric(at + "action", 1.0, batch.action);
    FillSymmetric(at + "next_obs", 1.5, batch.next_obs_vector);
    FillSymmetric(at + "reward", 2.0, batch.reward);
    std::ranges::fill(batch.bootstrap, 1.f);
    batch.bootstrap[size_t(update % kBatch)] = batch.bootstrap[size_t((update + 3) % kBatch)] = 0;
  }

  bool Has(int update, const std::string& name) const {
    return recorded_.contains(std::to_string(update) + "." + name);
  }
  std::vector<float> Recorded(int update, const std::string& name) const {
    return Floats(recorded_, std::to_string(update) + "." + name);
  }

  // Every parameter and target when the update is over.
  void ExpectTheirParameters(int update) const {
    const nn::TensorMap tensors = agent_->AllTensors();
    for (const Layer& layer : layers_) {
      for (const char* kind : {".weight", ".bias"}) {
        const auto ours = Floats(tensors, layer.ours + kind);
        const auto theirs = Recorded(update, "after." + layer.theirs + kind);
        ASSERT_EQ(ours.size(), theirs.size());
        for (size_t i = 0; i < ours.size(); ++i) {
          ASSERT_NEAR(ours[i], theirs[i], 5e-6) << layer.ours << kind << " " << i;
        }
      }
    }
  }

  // The gradients, read off Adam's first moments before and after: m' = 0.9 m + 0.1 g.
  void ExpectTheirGradients(int update, const nn::TensorMap& before) const {
    const nn::TensorMap after = agent_->AllTensors();
    int compared = 0;
    for (const Layer& layer : layers_) {
      for (const char* kind : {".weight", ".bias"}) {
        if (!Has(update, "gradient." + layer.theirs + kind)) continue;
        const auto theirs = Recorded(update, "gradient." + layer.theirs + kind);
        const std::string moment = "adam.m." + layer.ours + kind;
        const auto m = Floats(before, moment), next = Floats(after, moment);
        const float largest =
            std::abs(*std::ranges::max_element(theirs, {}, [](float g) { return std::abs(g); }));
        ASSERT_GT(largest, 0) << layer.theirs;
        for (size_t i = 0; i < theirs.size(); ++i) {
          const double ours = (next[i] - (1 - kFirstMoment) * m[i]) / kFirstMoment;
          ASSERT_NEAR(ours, theirs[i], 1e-4 * largest) << layer.ours << kind << " " << i;
        }
        ++compared;
      }
    }
    EXPECT_GE(compared, 6);
  }

  const nn::TensorMap recorded_;
  ObservationSpec spec_;
  Config config_;
  std::vector<Layer> layers_;
  std::unique_ptr<Agent> agent_;
};

TEST_P(Sb3UpdatesTest, LossesGradientsParametersAndTargetsAreTheirs) {
  const RandomBatch batch(spec_, kBatch, 1);
  for (int update = 0; update < kUpdates; ++update) {
    SCOPED_TRACE(update);
    Fill(update, batch.View());
    const nn::TensorMap before = agent_->AllTensors();
    const UpdateOutcome outcome = agent_->Update(batch.View());
    ASSERT_TRUE(outcome.finite);
    const auto y = Recorded(update, "target");
    double mean = 0;
    for (const float target : y) mean += double(target) / double(y.size());
    EXPECT_NEAR(Get(outcome, kTargetMean), mean, 1e-5);
    const float critic_loss = Recorded(update, "critic_loss")[0];
    EXPECT_NEAR(Get(outcome, kCriticLoss), critic_loss, 1e-5 * std::abs(critic_loss));
    ASSERT_EQ(outcome.figures.Get(kActorLoss).has_value(), Has(update, "actor_loss"));
    if (Has(update, "actor_loss")) {
      EXPECT_NEAR(Get(outcome, kActorLoss), Recorded(update, "actor_loss")[0], 1e-5);
    }
    ExpectTheirGradients(update, before);
    ExpectTheirParameters(update);
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Sb3UpdatesTest,
                         testing::Values(Case{"td3", {.critics = 2}, 2},
                                         Case{"ddpg", {.critics = 1}, 1}),
                         [](const auto& each) { return std::string(each.param.name); });

}  // namespace
}  // namespace shoal::learner
