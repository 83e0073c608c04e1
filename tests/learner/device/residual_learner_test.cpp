// SPDX-License-Identifier: Apache-2.0
// A small learner whose encoder has batch normalisation, skips and pools, with an engine on a
// device beside the CPU's engine. It stands for the encoders resnet18 and alexnet, which are slow
// in host memory.
#include <gmock/gmock.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "common/nn/adam.h"
#include "common/nn/critic_module.h"
#include "common/nn/encoder_module.h"
#include "learner/agent/agent_state.h"
#include "learner/agent/figure_sheet.h"
#include "learner/agent/policy_average.h"
#include "tests/common/nn/residual_plan.h"
#include "tests/learner/device/device_fixture.h"

namespace shoal::learner::device {
namespace {

using testing::IsEmpty;
using Use = nn::Module::Use;

constexpr int kRowsOfLearner = 5;
constexpr float kTau = 0.1f, kAverageRate = 0.25f;

ObservationSpec ResidualSpec() {
  ObservationSpec spec = SmallSpec();
  spec.height = 13;
  spec.width = 11;
  return spec;
}

RandomBatch ResidualBatch(uint64_t key) { return {ResidualSpec(), kRowsOfLearner, key}; }

nn::HeadPlan ResidualHead(const std::string& name) {
  nn::HeadPlan plan{.trunk = nn::NetworkPlan(nn::ResidualPlan().output()),
                    .vector_columns = 2,
                    .extra_columns = 2};
  plan.trunk.Add(nn::NetworkPlan::Linear{.name = name + ".trunk",
                                         .key = "k",
                                         .outputs = 9,
                                         .layer_norm = true,
                                         .activation = nn::Activation::kTanh});
  for (const char* q : {".q1", ".q2"}) {
    nn::NetworkPlan mlp({9 + 2 + 2});
    mlp.Add(nn::NetworkPlan::Linear{.name = name + q + ".layer0",
                                    .key = "k",
                                    .outputs = 8,
                                    .layer_norm = true,
                                    .activation = nn::Activation::kRelu});
    mlp.Add(nn::NetworkPlan::Linear{.name = name + q + ".output", .key = "k", .outputs = 1});
    plan.mlps.push_back(mlp);
  }
  return plan;
}

// Q functions of the batch's actions, with a target encoder and target heads.
class ResidualLearner {
 public:
  explicit ResidualLearner(Engine* engine)
      : engine_(engine),
        encoder_(nn::ResidualPlan("encoder."), Use::kTraining, engine->modules()),
        target_encoder_(nn::ResidualPlan("target_encoder."), Use::kInference, engine->modules()),
        critic_(ResidualHead("critic"), &encoder_.features(), true, Use::kTraining,
                engine->modules()),
        target_(ResidualHead("target"), &target_encoder_.features(), false, Use::kInference,
                engine->modules()),
        average_({&encoder_.parameters()}, engine),
        optimiser_({&encoder_.parameters(), &critic_.parameters()}, {.rate = 1e-3},
                   engine->modules()),
        y_(engine->NewArray(1)),
        q_gradients_{engine->NewArray(1), engine->NewArray(1)},
        numbers_(NewCriticNumbers(2, engine)),
        squares_(engine->NewNumber()) {
    for (nn::Module* module : std::array<nn::Module*, 2>{&encoder_, &critic_}) {
      module->parameters().Initialise(3);
      module->Refresh();
    }
    nn::CopyParameters(encoder_, &target_encoder_);
    nn::CopyParameters(critic_, &target_);
    average_.Copy();
    for (nn::Module* module :
         std::array<nn::Module*, 4>{&encoder_, &critic_, &target_encoder_, &target_}) {
      state_.Add(module);
    }
    average_.AddTo(&state_);
    state_.Add(&optimiser_, "critic");
  }

  std::optional<Engine::Outcome> Update(const RandomBatch& drawn) {
    engine_->Begin(drawn.View());
    const Transitions batch = engine_->Take(drawn.View());
    target_encoder_.Forward(batch.next_obs_frames, nn::Statistics::kRunning);
    const auto next_q = Evaluate(&target_, batch.next_obs_vector, batch.action);
    engine_->Targets({.reward = batch.reward,
                      .bootstrap = batch.bootstrap,
                      .next_q = next_q,
                      .next_log_prob = {},
                      .temperature = {},
                      .reward_scale = 2,
                      .discount = 0.9f,
                      .bounds = {}},
                     y_);
    encoder_.Forward(batch.obs_frames, nn::Statistics::kBatch);
    engine_->CriticLoss(Evaluate(&critic_, batch.obs_vector, batch.action), y_, /*rows=*/{},
                        q_gradients_, numbers_);
    critic_.Backward(q_gradients_);
    encoder_.Backward();
    engine_->Gather(&optimiser_, squares_);
    engine_->RequireFinite(numbers_.loss);
    nn::Module* const changed[] = {&encoder_, &critic_};
    engine_->Step(&optimiser_, changed, NextUse::kNextUpdate);
    engine_->MoveTowards(kTau, std::array{nn::Following{&encoder_, &target_encoder_},
                                          nn::Following{&critic_, &target_}});
    average_.Move(kAverageRate);
    return engine_->End();
  }
  double loss() const { return engine_->Read(numbers_.loss); }
  double gradient_squares() const { return engine_->Read(squares_); }
  nn::TensorMap Tensors() const { return state_.Export(); }
  void Restore(const nn::TensorMap& tensors) { state_.Restore(tensors, "test"); }

 private:
  std::array<Array, 2> Evaluate(nn::CriticModule* critic, Array vector, Array action) {
    critic->ForwardObservation(vector);
    critic->ForwardAction(action);
    return {critic->q(0), critic->q(1)};
  }

  Engine* const engine_;
  nn::EncoderModule encoder_, target_encoder_;
  nn::CriticModule critic_, target_;
  PolicyAverage average_;
  nn::Adam optimiser_;
  const Array y_;
  const std::array<Array, 2> q_gradients_;
  const CriticNumbers numbers_;
  const Number squares_;
  AgentState state_;
};

struct ResidualOnCpu {
  nn::Replica alone;
  CpuEngine engine{nn::Precision::kF32, kRowsOfLearner, &alone};
  ResidualLearner learner{&engine};
};

struct ResidualOnDevice {
  explicit ResidualOnDevice(nn::Precision precision, int in_flight = 0,
                            const HostDevice::Options& options = kPadding)
      : device(options), engine(&device, precision, kRowsOfLearner, in_flight), learner(&engine) {}

  HostDevice device;
  DeviceEngine engine;
  ResidualLearner learner;
};

void LearnLikeTheCpu(nn::Precision precision, double first, double later, double moments) {
  ResidualOnCpu cpu;
  ResidualOnDevice device(precision);
  for (uint64_t u = 0; u < 20; ++u) {
    const RandomBatch batch = ResidualBatch(u);
    ASSERT_TRUE(cpu.learner.Update(batch)->finite && device.learner.Update(batch)->finite) << u;
    if (u > 0) continue;
    EXPECT_NEAR(device.learner.loss(), cpu.learner.loss(), first * cpu.learner.loss());
    EXPECT_NEAR(device.learner.gradient_squares(), cpu.learner.gradient_squares(),
                2 * first * cpu.learner.gradient_squares());
  }
  ExpectNear(device.learner.Tensors(), cpu.learner.Tensors(), later, moments);
}

TEST(ResidualLearner, LearnsLikeTheCpuInF32) {
  LearnLikeTheCpu(nn::Precision::kF32, 1e-4, 1e-3, 1e-2);
}

TEST(ResidualLearner, LearnsInBf16LikeTheCpuInF32) {
  LearnLikeTheCpu(nn::Precision::kBf16, 6e-2, 6e-2, 0);
}

// Targets and averages take running statistics whole.
TEST(ResidualLearner, StatisticsFollowTheBatchAndAreCopied) {
  ResidualOnDevice device(nn::Precision::kF32);
  const nn::TensorMap before = device.learner.Tensors();
  for (uint64_t u = 0; u < 3; ++u) device.learner.Update(ResidualBatch(u));
  const nn::TensorMap after = device.learner.Tensors();
  for (const char* name : {"stem.bn.running_mean", "b.around.bn.running_var"}) {
    const std::string of_encoder = std::string("encoder.") + name;
    EXPECT_NE(after.at(of_encoder).data, before.at(of_encoder).data) << name;
    for (const char* follower : {"target_", "average."}) {
      EXPECT_EQ(after.at(follower + of_encoder).data, after.at(of_encoder).data) << name;
    }
    EXPECT_FALSE(after.contains("adam.m." + of_encoder));
  }
  EXPECT_NE(after.at("target_encoder.stem.bn.weight").data,
            after.at("encoder.stem.bn.weight").data);
}

TEST(ResidualLearner, RepeatsItselfBitForBitWithUpdatesInFlight) {
  HostDevice::Options backward = kPadding;
  backward.order = kernels::HostOrder::kBackward;
  backward.first = Lane::kCopies;
  for (const nn::Precision precision : {nn::Precision::kF32, nn::Precision::kBf16}) {
    ResidualOnDevice waiting(precision), flying(precision, 2, backward);
    for (uint64_t u = 0; u < 8; ++u) {
      const RandomBatch batch = ResidualBatch(u);
      waiting.learner.Update(batch);
      flying.learner.Update(batch);
    }
    EXPECT_EQ(flying.engine.recorded(), 2);
    EXPECT_THAT(Differences(flying.learner.Tensors(), waiting.learner.Tensors()), IsEmpty());
  }
}

TEST(ResidualLearner, AnUpdateThatIsNotFiniteLeavesStatisticsAsTheyWere) {
  ResidualOnDevice clean(nn::Precision::kF32), spoilt(nn::Precision::kF32, 2);
  uint64_t key = 0;
  for (const float reward : {NAN, 1e25f}) {
    for (int u = 0; u < 2; ++u, ++key) {
      clean.learner.Update(ResidualBatch(key));
      spoilt.learner.Update(ResidualBatch(key));
    }
    const RandomBatch bad = ResidualBatch(100);
    bad.View().reward[2] = reward;
    spoilt.learner.Update(bad);
    spoilt.learner.Update(ResidualBatch(101));
    const auto outcome = spoilt.learner.Update(ResidualBatch(102));
    ASSERT_TRUE(outcome);
    EXPECT_FALSE(outcome->finite);
    EXPECT_THAT(Differences(spoilt.learner.Tensors(), clean.learner.Tensors()), IsEmpty());
  }
}

TEST(ResidualLearner, CheckpointsMoveBetweenDeviceAndCpu) {
  ResidualOnDevice first(nn::Precision::kF32), third(nn::Precision::kF32);
  ResidualOnCpu expected, second;
  for (uint64_t u = 0; u < 6; ++u) expected.learner.Update(ResidualBatch(u));
  for (uint64_t u = 0; u < 2; ++u) first.learner.Update(ResidualBatch(u));
  const nn::TensorMap written = first.learner.Tensors();
  second.learner.Restore(written);
  EXPECT_THAT(Differences(second.learner.Tensors(), written), IsEmpty());
  for (uint64_t u = 2; u < 4; ++u) second.learner.Update(ResidualBatch(u));
  third.learner.Restore(second.learner.Tensors());
  EXPECT_THAT(Differences(third.learner.Tensors(), second.learner.Tensors()), IsEmpty());
  for (uint64_t u = 4; u < 6; ++u) third.learner.Update(ResidualBatch(u));
  ExpectNear(third.learner.Tensors(), expected.learner.Tensors(), 1e-3, 1e-2);
}

}  // namespace
}  // namespace shoal::learner::device
