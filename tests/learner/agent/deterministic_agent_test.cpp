// SPDX-License-Identifier: Apache-2.0
// The common part of TD3, DDPG and DrQ-v2. Compares one update with a reference in double
// precision: losses, and every gradient by central differences.
//
// The gradients are computed from Adam's first moment, which was 0 before: m = (1 - 0.9) g. Targets
// differ much from the networks that they follow, so that an exchange of networks is detected.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <numeric>

#include "common/base/error.h"
#include "common/nn/policy.h"
#include "tests/common/nn/reference_network.h"
#include "tests/learner/agent/adam_moments.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

using nn::ToDoubles;
using nn::reference::Network;
using nn::reference::Values;

struct Case {
  std::string algorithm;
  std::vector<std::string> critics;  // MLPs of a critic
  double noise = 0, noise_clip = 0;  // on the target's action, at kStoredSteps
  bool is_drqv2 = false;  // no target actor; the actor's loss has noise and the smaller Q
  double mean_penalty = 0;
  std::string name = algorithm;

  std::string ActorOfTargets() const { return is_drqv2 ? "actor" : "target_actor"; }
};

// Half of the schedule of the noise.
constexpr uint64_t kStoredSteps = 500;

void PrintTo(const Case& each, std::ostream* out) { *out << each.name; }

Config ConfigOf(const Case& each) {
  Config config = SmallConfig();
  config.learner.algorithm = each.algorithm;
  config.learner.actor_period = config.learner.target_period = 1;
  config.learner.mean_penalty = each.mean_penalty;
  if (each.is_drqv2) {
    config.drqv2 = {.noise = {.start = each.noise + 0.2,
                              .end = each.noise - 0.2,
                              .env_steps = 2 * int64_t{kStoredSteps}},
                    .noise_clip = each.noise_clip};
  } else if (each.noise > 0) {
    config.td3 = {.target_noise = each.noise, .target_noise_clip = each.noise_clip};
  }
  return config;
}

class DeterministicAgentTest : public testing::TestWithParam<Case> {
 protected:
  // (B, A) before tanh.
  Values Mean(const Network& network, const std::string& head, const Values& features,
              const Values& vector) const {
    return network.Mlp(head + ".mlp", batch_size_,
                       network.Observation(head, batch_size_, features, vector));
  }

  Values Action(const Network& network, const std::string& head, const Values& features,
                const Values& vector) const {
    Values action = Mean(network, head, features, vector);
    for (double& a : action) a = std::tanh(a);
    return action;
  }

  // Q (B) of one MLP of `head`.
  Values Q(const Network& network, const std::string& head, const std::string& mlp,
           const Values& features, const Values& vector, const Values& action) const {
    const Values observation = network.Observation(head, batch_size_, features, vector);
    const size_t columns = observation.size() / size_t(batch_size_);
    const auto actions = size_t(spec_.action_size);
    Values input;
    for (size_t b = 0; b < size_t(batch_size_); ++b) {
      input.insert(input.end(), observation.begin() + long(b * columns),
                   observation.begin() + long((b + 1) * columns));
      input.insert(input.end(), action.begin() + long(b * actions),
                   action.begin() + long((b + 1) * actions));
    }
    return network.Mlp(head + "." + mlp, batch_size_, input);
  }

  // Draws the noise of an action, and adds it.
  Values WithNoise(Values action, Random* random) const {
    const double most = GetParam().noise_clip;
    if (GetParam().noise == 0) return action;
    for (double& a : action) {
      const double noise = std::clamp(GetParam().noise * random->Normal(), -most, most);
      a = std::clamp(a + noise, -1.0, 1.0);
    }
    return action;
  }

  Values Targets(const Network& network, Random* random) const {
    const BatchView view = data_.View();
    const Values features = network.Features(batch_size_, view.next_obs_frames.data());
    const Values vector = ToDoubles(view.next_obs_vector);
    const Values action =
        WithNoise(Action(network, GetParam().ActorOfTargets(), features, vector), random);
    Values smallest(size_t(batch_size_), INFINITY);
    for (const std::string& mlp : GetParam().critics) {
      const Values q = Q(network, "target", mlp, features, vector, action);
      for (size_t b = 0; b < q.size(); ++b) smallest[b] = std::min(smallest[b], q[b]);
    }
    Values y;
    for (size_t b = 0; b < smallest.size(); ++b) {
      y.push_back(config_.learner.reward_scale * view.reward[b] +
                  view.bootstrap[b] * config_.learner.discount * smallest[b]);
    }
    return y;
  }

  double CriticLoss(const Network& network, const Values& y) const {
    const BatchView view = data_.View();
    const Values features = network.Features(batch_size_, view.obs_frames.data());
    double loss = 0;
    for (const std::string& mlp : GetParam().critics) {
      const Values q =
          Q(network, "critic", mlp, features, ToDoubles(view.obs_vector), ToDoubles(view.action));
      for (size_t b = 0; b < q.size(); ++b) loss += (q[b] - y[b]) * (q[b] - y[b]);
    }
    return loss / batch_size_;
  }

  // The difference that noise and clipping make to the actor's actions. The gradient takes it as a
  // constant.
  Values NoiseOfActor(const Network& network, const Values& features, Random* random) const {
    const Values vector = ToDoubles(data_.View().obs_vector);
    const Values action = Action(network, "actor", features, vector);
    Values noise(action.size(), 0);
    if (!GetParam().is_drqv2) return noise;
    const Values noisy = WithNoise(action, random);
    EXPECT_GT(std::ranges::count_if(noisy, [](double a) { return std::abs(a) == 1; }), 1);
    for (size_t i = 0; i < noise.size(); ++i) noise[i] = noisy[i] - action[i];
    return noise;
  }

  // The actor of `network` judged by the critics of `judge`, on given features.
  double ActorLoss(const Network& network, const Network& judge, const Values& features,
                   const Values& noise) const {
    const Values vector = ToDoubles(data_.View().obs_vector);
    Values action = Action(network, "actor", features, vector);
    for (size_t i = 0; i < action.size(); ++i) action[i] += noise[i];
    Values q = Q(judge, "critic", "q1", features, vector, action);
    if (GetParam().is_drqv2) {
      const Values second = Q(judge, "critic", "q2", features, vector, action);
      for (size_t b = 0; b < q.size(); ++b) q[b] = std::min(q[b], second[b]);
    }
    const Values mean = Mean(network, "actor", features, vector);
    const double squares = std::inner_product(mean.begin(), mean.end(), mean.begin(), 0.0);
    return -std::accumulate(q.begin(), q.end(), 0.0) / batch_size_ +
           GetParam().mean_penalty * squares / double(mean.size());
  }

  const ObservationSpec spec_ = SmallSpec();
  const Config config_ = ConfigOf(GetParam());
  const int batch_size_ = config_.learner.batch;
  const std::unique_ptr<Agent> agent_ = MakeAgent(config_, spec_, nn::Precision::kF32);
  RandomBatch data_{spec_, batch_size_, 3};
};

TEST_P(DeterministicAgentTest, ALaterUpdateFollowsTheEquations) {
  agent_->Restore(Perturbed(agent_->AllTensors(), "target"), "later");
  const nn::TensorMap before = agent_->AllTensors();
  BatchView view = data_.View();
  view.stored_steps = kStoredSteps;
  const UpdateOutcome outcome = agent_->Update(view);
  const nn::TensorMap after = agent_->AllTensors();
  Network network(before, config_.network, spec_);
  const Network updated(after, config_.network, spec_);
  Random random(StreamKey(uint64_t(config_.seed), StreamRole::kLearnerUpdate, 0));

  const Values y = Targets(network, &random);
  const auto critic_loss = [&] { return CriticLoss(network, y); };
  EXPECT_NEAR(Get(outcome, kCriticLoss), critic_loss(), 1e-4 * critic_loss());
  ExpectMoments(after, "encoder.", &network, critic_loss);
  ExpectMoments(after, "critic.", &network, critic_loss);

  // The actor sees the features of before and the critic of after its step.
  const Values features = network.Features(batch_size_, data_.View().obs_frames.data());
  const Values noise = NoiseOfActor(network, features, &random);
  const auto actor_loss = [&] { return ActorLoss(network, updated, features, noise); };
  EXPECT_NEAR(Get(outcome, kActorLoss), actor_loss(), 1e-4 * std::abs(actor_loss()));
  ExpectMoments(after, "actor.", &network, actor_loss);

  // And the targets follow by tau.
  EXPECT_EQ(after.contains("target_actor.mlp.output.weight"), !GetParam().is_drqv2);
  for (const auto& [target, online] :
       {std::pair{"target.", "critic."}, {"target_actor.", "actor."}}) {
    for (const auto& [name, tensor] : after) {
      if (!name.starts_with(target)) continue;
      const auto x = Floats(before, name), moved = Floats(after, name);
      const auto w = Floats(after, online + name.substr(std::string(target).size()));
      for (size_t i = 0; i < x.size(); ++i) {
        ASSERT_NEAR(moved[i], x[i] + config_.learner.tau * (w[i] - x[i]), 1e-6) << name;
      }
    }
  }
}

TEST_P(DeterministicAgentTest, ActorAndTargetsMoveInEveryPeriodthUpdate) {
  Config config = config_;
  config.learner.actor_period = 2;
  config.learner.target_period = 3;
  const auto agent = MakeAgent(config, spec_, nn::Precision::kF32);
  for (int u = 1; u <= 6; ++u) {
    const nn::TensorMap before = agent->AllTensors();
    const UpdateOutcome outcome = agent->Update(data_.View());
    const nn::TensorMap after = agent->AllTensors();
    EXPECT_FALSE(Differences(before, after, "critic.").empty()) << u;
    EXPECT_EQ(!Differences(before, after, "actor.").empty(), u % 2 == 0) << u;
    EXPECT_EQ(outcome.figures.Get(kActorLoss).has_value(), u % 2 == 0) << u;
    EXPECT_EQ(!Differences(before, after, "target.").empty(), u % 3 == 0) << u;
    EXPECT_EQ(!Differences(before, after, "target_actor.").empty(),
              !GetParam().is_drqv2 && u >= 2 && u % 3 == 0)
        << u;
  }
}

TEST_P(DeterministicAgentTest, GoesOnByteForByteFromWhatItExported) {
  Config config = config_;
  config.learner.actor_period = config.learner.target_period = 2;
  const auto original = MakeAgent(config, spec_, nn::Precision::kF32);
  for (int u = 0; u < 3; ++u) original->Update(data_.View());
  const auto restored = MakeAgent(config, spec_, nn::Precision::kF32);
  restored->Restore(original->AllTensors(), "original");
  EXPECT_EQ(restored->updates(), 3u);
  for (uint64_t u = 0; u < 20; ++u) {
    const RandomBatch batch(spec_, batch_size_, 50 + u);
    original->Update(batch.View());
    restored->Update(batch.View());
  }
  EXPECT_THAT(Differences(original->AllTensors(), restored->AllTensors()), testing::IsEmpty());
}

TEST_P(DeterministicAgentTest, RestoreRefusesWhatDoesNotFitAndChangesNothing) {
  const auto other = MakeAgent(config_, spec_, nn::Precision::kF32);
  other->Update(data_.View());
  const nn::TensorMap before = agent_->AllTensors();
  const std::string actor_of_targets = GetParam().ActorOfTargets() + ".mlp.output.weight";
  for (const std::string& name : {std::string("encoder.conv1.bias"), actor_of_targets,
                                  std::string("average.actor.mlp.output.bias"),
                                  std::string("adam.steps.actor"), std::string("agent.updates")}) {
    nn::TensorMap tensors = other->AllTensors();
    ASSERT_EQ(tensors.erase(name), 1u) << name;
    EXPECT_THAT([&] { agent_->Restore(tensors, "checkpoint 5"); },
                testing::ThrowsMessage<Error>(testing::HasSubstr(name)));
    EXPECT_THAT(Differences(before, agent_->AllTensors()), testing::IsEmpty()) << name;
  }
}

TEST_P(DeterministicAgentTest, ABatchThatIsNotFiniteChangesNothing) {
  const nn::TensorMap before = agent_->AllTensors();
  BatchView view = data_.View();
  view.reward[1] = std::nanf("");
  EXPECT_FALSE(agent_->Update(view).finite);
  view.reward[1] = 1e25f;  // finite, but its squared error is not
  EXPECT_FALSE(agent_->Update(view).finite);
  EXPECT_THAT(Differences(before, agent_->AllTensors()), testing::IsEmpty());
}

TEST_P(DeterministicAgentTest, ItsPolicyHasNoDeviation) {
  nn::Policy policy(config_.network, spec_, nn::Precision::kF32, batch_size_);
  policy.Load(agent_->PolicyTensors(), "agent");
  const BatchView view = data_.View();
  const nn::PolicyOutput output =
      policy.Forward(batch_size_, view.obs_frames.data(), view.obs_vector.data());
  EXPECT_FALSE(output.mean.empty());
  EXPECT_TRUE(output.log_std.empty());
}

// Without the penalty a policy whose actions are all at a bound stays there: the gradient through
// tanh is 0.
TEST_P(DeterministicAgentTest, OnlyAPenaltyMovesASaturatedPolicy) {
  nn::TensorMap tensors = agent_->AllTensors();
  nn::NamedTensor& bias = tensors.at("actor.mlp.output.bias");
  const std::vector<float> far(bias.data.size() / sizeof(float), 40.f);
  std::memcpy(bias.data.data(), far.data(), bias.data.size());
  agent_->Restore(tensors, "saturated");
  agent_->Update(data_.View());
  const bool moved = !Differences(tensors, agent_->AllTensors(), "actor.").empty();
  EXPECT_EQ(moved, GetParam().mean_penalty > 0);
}

TEST_P(DeterministicAgentTest, LearnsABandit) {
  Config config = config_;
  config.drqv2 = Config().drqv2;
  EXPECT_LT(BanditError(config, MakeAgent), 0.08);
}

INSTANTIATE_TEST_SUITE_P(Of, DeterministicAgentTest,
                         testing::Values(Case{.algorithm = "td3",
                                              .critics = {"q1", "q2"},
                                              .noise = 0.3,
                                              .noise_clip = 0.4},
                                         Case{.algorithm = "ddpg", .critics = {"q1"}},
                                         Case{.algorithm = "td3",
                                              .critics = {"q1", "q2"},
                                              .noise = 0.3,
                                              .noise_clip = 0.4,
                                              .mean_penalty = 0.7,
                                              .name = "td3_with_a_penalty"},
                                         Case{.algorithm = "drqv2",
                                              .critics = {"q1", "q2"},
                                              .noise = 1.5,
                                              .noise_clip = 1.3,
                                              .is_drqv2 = true}),
                         [](const auto& each) { return each.param.name; });

}  // namespace
}  // namespace shoal::learner
