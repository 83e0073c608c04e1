// SPDX-License-Identifier: Apache-2.0
// Compares one whole update with a reference in double precision: losses, and every gradient by
// central differences.
//
// The gradients are computed from Adam's first moment, which was 0 before: m = (1 - 0.9) g. Targets
// and temperature differ from those of a fresh agent, so that an exchange is detected.
#include <numbers>

#include "tests/common/nn/reference_network.h"
#include "tests/learner/agent/adam_moments.h"
#include "tests/learner/agent/agent_fixture.h"

namespace shoal::learner {
namespace {

using nn::CentralDifference;
using nn::ToDoubles;
using nn::reference::Network;
using nn::reference::Values;

struct Sample {
  Values action, log_prob;
};

class SacGradientTest : public testing::Test {
 protected:
  SacGradientTest()
      : agent_(MakeAgent(config_, spec_, nn::Precision::kF32)), data_(spec_, batch_size_, 3) {}

  // tanh-Gaussian actions with the noise the agent draws: (B, A) per call.
  Sample Draw(const Network::Gaussian& gaussian, const Values& noise) const {
    Sample sample{{}, Values(size_t(batch_size_))};
    const size_t actions = size_t(spec_.action_size);
    for (size_t i = 0; i < noise.size(); ++i) {
      const double u = gaussian.mean[i] + std::exp(gaussian.log_std[i]) * noise[i];
      sample.action.push_back(std::tanh(u));
      sample.log_prob[i / actions] += -0.5 * noise[i] * noise[i] - gaussian.log_std[i] -
                                      0.5 * std::log(2 * std::numbers::pi) -
                                      std::log(1 - std::tanh(u) * std::tanh(u));
    }
    return sample;
  }

  Values Noise(Random* random) const {
    Values noise(size_t(batch_size_ * spec_.action_size));
    for (double& value : noise) value = float(random->Normal());
    return noise;
  }

  Values Targets(const Network& network, const Values& noise) const {
    const BatchView view = data_.View();
    const Values features = network.Features(batch_size_, view.next_obs_frames.data());
    const Values vector = ToDoubles(view.next_obs_vector);
    const Sample next = Draw(network.Actor(batch_size_, features, vector), noise);
    const auto q = network.Critic("target", batch_size_, features, vector, next.action);
    Values y;
    for (size_t b = 0; b < size_t(batch_size_); ++b) {
      const double value = std::min(q.q1[b], q.q2[b]) - temperature_ * next.log_prob[b];
      y.push_back(config_.learner.reward_scale * view.reward[b] +
                  view.bootstrap[b] * config_.learner.discount * value);
    }
    return y;
  }

  double CriticLoss(const Network& network, const Values& y) const {
    const BatchView view = data_.View();
    const auto q =
        network.Critic("critic", batch_size_, network.Features(batch_size_, view.obs_frames.data()),
                       ToDoubles(view.obs_vector), ToDoubles(view.action));
    double loss = 0;
    for (size_t b = 0; b < y.size(); ++b) {
      loss += (q.q1[b] - y[b]) * (q.q1[b] - y[b]) + (q.q2[b] - y[b]) * (q.q2[b] - y[b]);
    }
    return loss / batch_size_;
  }

  // The actor of `network` judged by the critic of `critic`, on given features.
  double ActorLoss(const Network& network, const Network& critic, const Values& features,
                   const Values& noise) const {
    const Values vector = ToDoubles(data_.View().obs_vector);
    const Sample sample = Draw(network.Actor(batch_size_, features, vector), noise);
    const auto q = critic.Critic("critic", batch_size_, features, vector, sample.action);
    double loss = 0;
    for (size_t b = 0; b < sample.log_prob.size(); ++b) {
      loss += temperature_ * sample.log_prob[b] - std::min(q.q1[b], q.q2[b]);
    }
    return loss / batch_size_;
  }

  const ObservationSpec spec_ = SmallSpec();
  const Config config_ = SmallConfig();
  const int batch_size_ = config_.learner.batch;
  const double temperature_ = 0.37;
  const std::unique_ptr<Agent> agent_;
  RandomBatch data_;
};

TEST_F(SacGradientTest, ALaterUpdateFollowsTheEquations) {
  nn::TensorMap later = Perturbed(agent_->AllTensors(), "target.");
  const auto log_temperature = float(std::log(temperature_));
  std::memcpy(later.at("temperature.log").data.data(), &log_temperature, sizeof(float));
  agent_->Restore(later, "later");
  const nn::TensorMap before = agent_->AllTensors();
  const UpdateOutcome stats = agent_->Update(data_.View());
  const nn::TensorMap after = agent_->AllTensors();
  Network network(before, config_.network, spec_);
  const Network updated(after, config_.network, spec_);
  Random random(StreamKey(uint64_t(config_.seed), StreamRole::kLearnerUpdate, 0));
  const Values next_noise = Noise(&random), noise = Noise(&random);

  const Values y = Targets(network, next_noise);
  const auto critic_loss = [&] { return CriticLoss(network, y); };
  EXPECT_NEAR(Get(stats, kCriticLoss), critic_loss(), 1e-4 * critic_loss());
  ExpectMoments(after, "encoder.", &network, critic_loss);
  ExpectMoments(after, "critic.", &network, critic_loss);

  // The actor sees the features of before and the critic of after its step.
  const Values features = network.Features(batch_size_, data_.View().obs_frames.data());
  const auto actor_loss = [&] { return ActorLoss(network, updated, features, noise); };
  EXPECT_NEAR(Get(stats, kActorLoss), actor_loss(), 1e-4 * std::abs(actor_loss()));
  ExpectMoments(after, "actor.", &network, actor_loss);

  const Sample sample =
      Draw(network.Actor(batch_size_, features, ToDoubles(data_.View().obs_vector)), noise);
  double entropy = 0;
  for (const double log_prob : sample.log_prob) entropy -= log_prob / batch_size_;
  EXPECT_NEAR(Get(stats, kEntropy), entropy, 1e-4);
  const double temperature_loss = temperature_ * (entropy + spec_.action_size);
  EXPECT_NEAR(Floats(after, "adam.m.temperature.log")[0], kFirstMoment * temperature_loss, 1e-5);
}

}  // namespace
}  // namespace shoal::learner
