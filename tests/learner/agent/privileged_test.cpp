// SPDX-License-Identifier: Apache-2.0
// Learning with privileged inputs: compares asymmetric critics and the auxiliary loss with a
// reference in double precision, as in sac_gradient_test.cpp.
#include <gmock/gmock.h>

#include <numbers>

#include "common/nn/vector_scale.h"
#include "learner/agent/running_moments.h"
#include "learner/agent/sac/sac_agent.h"
#include "tests/common/nn/reference_network.h"
#include "tests/learner/agent/adam_moments.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

using nn::ToDoubles;
using nn::reference::Beside;
using nn::reference::Network;
using nn::reference::Values;
using testing::IsEmpty;
using testing::Not;

// A spec of which the policy sees only the frames and the goal.
ObservationSpec PushSpec() {
  ObservationSpec spec = SmallSpec();
  spec.blocks = {{"grip", 2, /*observed=*/false}, {"goal", 2}, {"object", 2, false}};
  return spec;
}

class PrivilegedTest : public testing::Test {
 protected:
  PrivilegedTest() { config_.sac.aux = {"object-grip", "goal-object"}; }

  RandomBatch Batch(uint64_t key) const {
    return {spec_, BatchOptions{.batch = config_.learner.batch, .privileged = {"grip", "object"}},
            key};
  }
  std::unique_ptr<Agent> Make() const { return MakeAgent(config_, spec_, nn::Precision::kF32); }

  Values Noise(Random* random) const {
    Values noise(size_t(config_.learner.batch * spec_.action_size));
    for (double& value : noise) value = float(random->Normal());
    return noise;
  }

  // mean (W trunk + b - label / 0.15)^2, of the trunk of `head`.
  double AuxLoss(const Network& network, const std::string& head, const BatchView& batch) const {
    const int rows = config_.learner.batch;
    const Values observation = network.Observation(
        head, rows, network.Features(rows, batch.obs_frames.data()), Values(size_t(rows) * 2));
    const size_t features = size_t(config_.network.features);
    const Values &weight = network.parameters().at("aux.weight"),
                 &bias = network.parameters().at("aux.bias");
    double loss = 0;
    for (size_t b = 0; b < size_t(rows); ++b) {
      const float *goal = &batch.obs_vector[2 * b], *grip = &batch.obs_privileged[4 * b],
                  *object = grip + 2;
      const double labels[] = {object[0] - grip[0], object[1] - grip[1], goal[0] - object[0],
                               goal[1] - object[1]};
      for (size_t l = 0; l < 4; ++l) {
        double y = bias[l];
        for (size_t f = 0; f < features; ++f) {
          y += weight[l * features + f] * observation[b * (features + 2) + f];
        }
        loss += (y - labels[l] / 0.15) * (y - labels[l] / 0.15);
      }
    }
    return loss / (rows * 4);
  }

  const ObservationSpec spec_ = PushSpec();
  Config config_ = SmallConfig();
};

// The sample and its log-probability, and the loss of an actor whose critic sees [goal | grip |
// object].
double AsymmetricActorLoss(const Network& network, const Network& critic, const BatchView& batch,
                           const Values& noise, double temperature) {
  const int rows = int(batch.reward.size());
  const Values vector = ToDoubles(batch.obs_vector);
  const auto gaussian =
      network.Actor(rows, network.Features(rows, batch.obs_frames.data()), vector);
  Values action, log_prob(size_t(rows), 0.0);
  for (size_t i = 0; i < noise.size(); ++i) {
    action.push_back(std::tanh(gaussian.mean[i] + std::exp(gaussian.log_std[i]) * noise[i]));
    log_prob[i / 2] += -0.5 * noise[i] * noise[i] - gaussian.log_std[i] -
                       0.5 * std::log(2 * std::numbers::pi) - std::log(1 - action[i] * action[i]);
  }
  const Values input = Beside(rows, Beside(rows, vector, ToDoubles(batch.obs_privileged)), action);
  const Values q1 = critic.Mlp("critic.q1", rows, input), q2 = critic.Mlp("critic.q2", rows, input);
  double loss = 0;
  for (size_t b = 0; b < q1.size(); ++b) {
    loss += (temperature * log_prob[b] - std::min(q1[b], q2[b])) / rows;
  }
  return loss;
}

TEST_F(PrivilegedTest, AnAsymmetricCriticLeavesTheEncoderToTheActorAndTheLabels) {
  config_.sac.critic_blocks = true;
  config_.sac.aux_weight = 0.7;
  const auto agent = Make();
  const nn::TensorMap before = agent->AllTensors();
  const RandomBatch data = Batch(3);
  const BatchView batch = data.View();
  const UpdateOutcome stats = agent->Update(batch);
  const nn::TensorMap after = agent->AllTensors();
  Network network(before, config_.network, spec_);
  const Network updated(after, config_.network, spec_);
  Random random(StreamKey(uint64_t(config_.seed), StreamRole::kLearnerUpdate, 0));
  Noise(&random);  // of the target
  const Values noise = Noise(&random);
  const double temperature = config_.sac.initial_temperature;
  EXPECT_NEAR(Get(stats, kActorLoss),
              AsymmetricActorLoss(network, updated, batch, noise, temperature), 1e-4);
  const double error = 0.15 * std::sqrt(AuxLoss(network, "actor", batch));
  EXPECT_NEAR(Get(stats, kAuxError), error, 1e-4 * error);
  const auto loss = [&] {
    return AsymmetricActorLoss(network, updated, batch, noise, temperature) +
           0.7 * AuxLoss(network, "actor", batch);
  };
  for (const char* prefix : {"encoder.", "actor.", "aux."}) {
    ExpectMoments(after, prefix, &network, loss);
  }
  // Input of the critic's loss: q_i of [goal | grip | object | action].
  const Values input = Beside(
      config_.learner.batch,
      Beside(config_.learner.batch, ToDoubles(batch.obs_vector), ToDoubles(batch.obs_privileged)),
      ToDoubles(batch.action));
  double q_mean = 0;
  for (const char* q : {"critic.q1", "critic.q2"}) {
    for (const double value : network.Mlp(q, config_.learner.batch, input)) q_mean += value / 12;
  }
  EXPECT_NEAR(Get(stats, kQMean), q_mean, 1e-5);
}

TEST_F(PrivilegedTest, WithoutAnActorsUpdateAnAsymmetricCriticMovesAlone) {
  config_.sac.critic_blocks = StateBlocks(std::vector<std::string>{"object"});
  config_.learner.actor_period = 2;
  const auto agent = Make();
  ASSERT_TRUE(agent->Update(Batch(1).View()).finite);
  const nn::TensorMap before = agent->AllTensors();
  const UpdateOutcome stats = agent->Update(Batch(2).View());
  const nn::TensorMap after = agent->AllTensors();
  EXPECT_FALSE(stats.figures.Get(kAuxError));
  for (const char* still : {"encoder.", "actor.", "aux.", "adam.m.encoder."}) {
    EXPECT_THAT(Differences(before, after, still), IsEmpty());
  }
  EXPECT_THAT(Differences(before, after, "critic."), Not(IsEmpty()));
  EXPECT_THAT(Differences(before, after, "target."), Not(IsEmpty()));
}

// The policy's own blocks, those named, the action: 2 + 2 + 2 inputs; no trunk, no encoder.
TEST_F(PrivilegedTest, AnAsymmetricCriticHasNoPixels) {
  config_.sac.critic_blocks = StateBlocks({"object", "goal"});
  const nn::TensorMap tensors = Make()->AllTensors();
  EXPECT_EQ(tensors.at("critic.q1.layer0.weight").shape, (std::vector<int64_t>{12, 6}));
  EXPECT_FALSE(tensors.contains("critic.trunk.weight"));
  EXPECT_FALSE(tensors.contains("target.trunk.weight"));
  EXPECT_TRUE(tensors.contains("actor.trunk.weight"));
}

TEST_F(PrivilegedTest, ASharedEncoderIsTaughtWithTheCritic) {
  const auto agent = Make();
  const nn::TensorMap before = agent->AllTensors();
  const RandomBatch data = Batch(3);
  const UpdateOutcome stats = agent->Update(data.View());
  const nn::TensorMap after = agent->AllTensors();
  Network network(before, config_.network, spec_);
  const double error = 0.15 * std::sqrt(AuxLoss(network, "critic", data.View()));
  EXPECT_NEAR(Get(stats, kAuxError), error, 1e-4 * error);
  // In addition to the gradient of the critic's loss, which equals that of a run without labels.
  config_.sac.aux = {};
  const auto plain = Make();
  ASSERT_TRUE(plain->Update(RandomBatch(spec_, config_.learner.batch, 3).View()).finite);
  nn::TensorMap by_labels = after;
  const nn::TensorMap without = plain->AllTensors();
  for (const auto& [name, tensor] : without) {
    if (!name.starts_with("adam.m.")) continue;
    std::vector<float> moment = Floats(after, name), of_critic = Floats(without, name);
    for (size_t i = 0; i < moment.size(); ++i) moment[i] -= of_critic[i];
    std::memcpy(by_labels.at(name).data.data(), moment.data(), by_labels.at(name).data.size());
  }
  for (const char* prefix : {"aux.", "encoder.", "critic.trunk."}) {
    ExpectMoments(by_labels, prefix, &network,
                  [&] { return AuxLoss(network, "critic", data.View()); });
  }
}

TEST_F(PrivilegedTest, ThePolicyIsThatOfTheSpecAlone) {
  config_.sac.critic_blocks = true;
  config_.learner.normalise_vectors = true;
  const auto agent = Make();
  ASSERT_TRUE(agent->Update(Batch(1).View()).finite);
  for (const nn::TensorMap& tensors : {agent->PolicyTensors(), agent->AveragedPolicyTensors()}) {
    for (const auto& [name, tensor] : tensors) {
      EXPECT_TRUE(name.starts_with("encoder.") || name.starts_with("actor.") ||
                  name.starts_with("observation."))
          << name;
    }
    EXPECT_EQ(tensors.at("observation.mean").shape, (std::vector<int64_t>{2}));
  }
}

TEST_F(PrivilegedTest, ARestoredAgentGoesOnBitForBit) {
  config_.sac.critic_blocks = true;
  config_.learner.normalise_vectors = true;
  const auto one = Make(), other = Make();
  for (uint64_t u = 0; u < 3; ++u) ASSERT_TRUE(one->Update(Batch(u).View()).finite);
  other->Restore(one->AllTensors(), "test");
  const RandomBatch next = Batch(9);
  ASSERT_TRUE(one->Update(next.View()).finite);
  ASSERT_TRUE(other->Update(next.View()).finite);
  EXPECT_THAT(Differences(one->AllTensors(), other->AllTensors()), IsEmpty());
}

// An update is that of a plain agent with the same parameters on vectors and blocks scaled by the
// moments of the updates before; the auxiliary loss has labels in metres in both.
TEST_F(PrivilegedTest, TheCriticSeesScaledBlocksAndTheAuxiliaryLossMetres) {
  config_.sac.critic_blocks = true;
  const auto plain = Make();
  config_.learner.normalise_vectors = true;
  const auto agent = Make();
  RunningMoments observed(2), privileged(4);
  for (uint64_t u = 0; u < 3; ++u) {
    const RandomBatch batch = Batch(u);
    const BatchView view = batch.View();
    for (float& x : view.obs_privileged) x = 50 + 7 * x;
    observed.Add(view.obs_vector);
    privileged.Add(view.obs_privileged);
    ASSERT_TRUE(agent->Update(view).finite);
  }
  nn::TensorMap networks = agent->AllTensors();
  for (const char* moments : {"observation.moments", "privileged.moments"}) networks.erase(moments);
  plain->Restore(networks, "agent");
  const RandomBatch batch = Batch(9), scaled = Batch(9);
  const BatchView from = batch.View(), to = scaled.View();
  const auto scale = [](const RunningMoments& moments, std::span<const float> x,
                        std::span<float> y) {
    nn::VectorScale(moments.Mean(), moments.Variance()).Apply(x.data(), y);
  };
  scale(observed, from.obs_vector, to.obs_vector);
  scale(observed, from.next_obs_vector, to.next_obs_vector);
  scale(privileged, from.obs_privileged, to.obs_privileged);
  scale(privileged, from.next_obs_privileged, to.next_obs_privileged);
  const UpdateOutcome a = agent->Update(from), b = plain->Update(to);
  EXPECT_EQ(Get(a, kCriticLoss), Get(b, kCriticLoss));
  EXPECT_EQ(Get(a, kTargetMean), Get(b, kTargetMean));
}

// Pixels show the position: a bright column at the place that the label names.
TEST_F(PrivilegedTest, TheEncoderLearnsWhatItIsTaught) {
  for (const bool asymmetric : {false, true}) {
    config_.sac.critic_blocks = asymmetric;
    config_.sac.aux = {"object"};
    config_.learner.learning_rate = 3e-3;
    config_.learner.actor_period = 1;
    config_.learner.batch = 32;
    const auto agent = Make();
    double first = 0, last = 0;
    for (uint64_t u = 0; u < 300; ++u) {
      const BatchOptions options{.batch = 32,
                                 .privileged = asymmetric
                                                   ? std::vector<std::string>{"grip", "object"}
                                                   : std::vector<std::string>{"object"}};
      const RandomBatch batch(spec_, options, u);
      const BatchView view = batch.View();
      const size_t privileged = view.obs_privileged.size() / 32, frame = 2 * 18 * 16;
      Random random(u);
      for (size_t b = 0; b < 32; ++b) {
        const auto column = size_t(random.Uniform(0, 15.99));
        for (size_t i = 0; i < frame; ++i) {
          view.obs_frames[b * frame + i] = i % 16 == column ? 255 : 20;
        }
        float* object = &view.obs_privileged[b * privileged + privileged - 2];
        object[0] = 0.3f * (float(column) / 15 - 0.5f);
        object[1] = 0;
      }
      const UpdateOutcome outcome = agent->Update(view);
      ASSERT_TRUE(outcome.finite);
      (u == 0 ? first : last) = Get(outcome, kAuxError);
    }
    EXPECT_GT(first, 0.06);
    EXPECT_LT(last, 0.025) << asymmetric;
  }
}

}  // namespace
}  // namespace shoal::learner
