// SPDX-License-Identifier: Apache-2.0
// Compares encoder, actor and critic, as algorithms use them, with a reference in double precision:
// options of the heads, the loss that trains an encoder, targets.
#include <gmock/gmock.h>

#include "common/nn/actor_module.h"
#include "common/nn/adam.h"
#include "common/nn/critic_module.h"
#include "common/nn/encoder_module.h"
#include "common/nn/features.h"
#include "common/nn/host_memory.h"
#include "tests/common/nn/network_fixture.h"

namespace shoal::nn {
namespace {

using reference::Values;
using Use = Module::Use;

constexpr int kRows = 3;

class ModulesTest : public LayerTest {
 protected:
  void SetUp() override {
    LayerTest::SetUp();
    frames_ = RandomFrames(spec_, kRows, 5);
  }

  // Off the special values that initialisation gives biases and norms.
  static void Start(Module* module, uint64_t seed) {
    module->parameters().Initialise(seed);
    Random random(seed);
    for (int64_t i = 0; i < module->parameters().size(); ++i) {
      module->parameters().values()[i] += float(0.1 * random.Normal());
    }
    module->Refresh();
  }

  reference::Network Reference(std::initializer_list<const Module*> modules) const {
    TensorMap tensors;
    for (const Module* module : modules) module->parameters().Export(&tensors);
    return reference::Network(tensors, network_, spec_);
  }

  // Output of the actor's MLP for its observation.
  Values Raw(const reference::Network& network) const {
    const Values features = network.Features(kRows, frames_.data());
    return network.Mlp("actor.mlp", kRows, network.Observation("actor", kRows, features, vector_));
  }

  // Gradients of a few elements of each parameter of `module` against differences of `loss`.
  void ExpectGradients(Module* module, reference::Network* network,
                       const std::function<double()>& loss) const {
    TensorMap tensors;
    module->parameters().Export(&tensors);
    for (const auto& [name, tensor] : tensors) {
      const std::span<const float> gradient = GradientOf(module->parameters(), name);
      std::vector<float> some;
      Values exact;
      for (size_t i = 0; i < gradient.size(); i += 1 + gradient.size() / 8) {
        some.push_back(gradient[i]);
        exact.push_back(CentralDifference(&network->at(name, i), loss));
      }
      EXPECT_LT(RelativeError(some, exact), GetParam() == Precision::kF32 ? 5e-4 : 0.2) << name;
    }
  }

  const NetworkConfig network_ = OddNetwork();
  const ObservationSpec spec_ = OddSpec(/*pixels=*/true);
  const ModuleContext context_{GetParam(), kRows, 1};
  const Values vector_ = RandomValues(kRows * 5, 3), action_ = RandomValues(kRows * 3, 4);
  std::vector<uint8_t> frames_;
};

TEST_P(ModulesTest, ADeterministicActorIsTheTanhOfItsMlpAndMayTrainItsOwnEncoder) {
  EncoderModule encoder(PlanEncoder(network_, spec_), Use::kTraining, context_);
  ActorModule actor(PlanActor(network_, spec_, ActorOutput::kDeterministic), &encoder.features(),
                    /*trains_encoder=*/true, Use::kTraining, context_);
  Start(&encoder, 1);
  Start(&actor, 2);
  encoder.Forward(HostArray(frames_), Statistics::kBatch);
  const auto [mean, log_std, action] = actor.Forward(HostArray(ToFloats(vector_)));
  EXPECT_FALSE(log_std);
  reference::Network network = Reference({&encoder, &actor});
  EXPECT_LT(RelativeError(HostValues(mean), Raw(network)), 2 * Tolerance(GetParam()));
  EXPECT_LT(RelativeError(HostValues(action), reference::Tanh(Raw(network))),
            2 * Tolerance(GetParam()));

  const Values daction = RandomValues(kRows * 3, 6);
  actor.BackwardAction(HostArray(ToFloats(daction)), 0);
  encoder.Backward();
  if (GetParam() != Precision::kF32) return;
  const auto loss = [&] { return Dot(daction, reference::Tanh(Raw(network))); };
  ExpectGradients(&actor, &network, loss);
  ExpectGradients(&encoder, &network, loss);
}

TEST_P(ModulesTest, AClampedDeviationHasNoGradientBeyondItsRange) {
  EncoderModule encoder(PlanEncoder(network_, spec_), Use::kInference, context_);
  ActorPlan plan = PlanActor(network_, spec_);
  plan.log_std = LogStd::kClamped;
  ActorModule actor(plan, &encoder.features(), /*trains_encoder=*/false, Use::kTraining, context_);
  Start(&encoder, 1);
  Start(&actor, 2);
  // Raw deviations of the three actions: within, above and below the range.
  float* bias = actor.parameters().Find("actor.mlp.output.bias").value();
  bias[3] = -1;
  bias[4] = 30;
  bias[5] = -60;
  actor.Refresh();
  encoder.Forward(HostArray(frames_), Statistics::kBatch);
  const std::span<const float> log_std =
      HostValues(actor.Forward(HostArray(ToFloats(vector_))).log_std);
  reference::Network network = Reference({&encoder, &actor});
  const auto clamped = [&] {
    Values result;
    const Values raw = Raw(network);
    for (size_t b = 0; b < kRows; ++b) {
      for (size_t j = 3; j < 6; ++j) result.push_back(std::clamp(raw[b * 6 + j], -20.0, 2.0));
    }
    return result;
  };
  EXPECT_LT(RelativeError(log_std, clamped()), 2 * Tolerance(GetParam()));
  EXPECT_EQ(log_std[1], 2.f);
  EXPECT_EQ(log_std[2], -20.f);

  const Values dmean = RandomValues(kRows * 3, 6), dlog_std = RandomValues(kRows * 3, 7);
  actor.Backward(HostArray(ToFloats(dmean)), HostArray(ToFloats(dlog_std)));
  EXPECT_EQ(GradientOf(actor.parameters(), "actor.mlp.output.bias")[4], 0.f);
  EXPECT_EQ(GradientOf(actor.parameters(), "actor.mlp.output.bias")[5], 0.f);
  if (GetParam() != Precision::kF32) return;
  ExpectGradients(&actor, &network, [&] {
    Values means;
    const Values raw = Raw(network);
    for (size_t b = 0; b < kRows; ++b) {
      means.insert(means.end(), raw.begin() + long(b) * 6, raw.begin() + long(b) * 6 + 3);
    }
    return Dot(dmean, means) + Dot(dlog_std, clamped());
  });
}

TEST_P(ModulesTest, ACriticOfAnyNumberOfFunctionsTrainsTheEncoderByThoseInTheLoss) {
  for (const auto& [count, outputs] : {std::pair{1, 1}, {3, 1}, {3, 4}}) {
    EncoderModule encoder(PlanEncoder(network_, spec_), Use::kTraining, context_);
    CriticModule critic(PlanCritic(network_, spec_, "critic", count, outputs), &encoder.features(),
                        /*trains_encoder=*/true, Use::kTraining, context_);
    Start(&encoder, 1);
    Start(&critic, 2);
    ASSERT_EQ(critic.count(), count);
    encoder.Forward(HostArray(frames_), Statistics::kBatch);
    critic.ForwardObservation(HostArray(ToFloats(vector_)));
    critic.ForwardAction(HostArray(ToFloats(action_)));
    reference::Network network = Reference({&encoder, &critic});
    const auto q = [&](int i, const Values& action) {
      const Values features = network.Features(kRows, frames_.data());
      const Values observation = network.Observation("critic", kRows, features, vector_);
      return network.Mlp("critic.q" + std::to_string(i + 1), kRows,
                         reference::Beside(kRows, observation, action));
    };
    for (int i = 0; i < count; ++i) {
      EXPECT_LT(RelativeError(HostValues(critic.q(i)), q(i, action_)), 2 * Tolerance(GetParam()));
    }

    // The last function alone is in the loss.
    const Values dq = RandomValues(size_t(kRows) * size_t(outputs), 6);
    const std::vector<float> last = ToFloats(dq);
    auto gradients = std::vector<Array>(size_t(count));
    gradients.back() = HostArray(last);
    std::vector<float> daction(kRows * 3, NAN);
    critic.BackwardAction(gradients, HostArray(daction));
    critic.Backward(gradients);
    encoder.Backward();
    if (GetParam() != Precision::kF32) continue;
    Values action = action_, exact;
    for (double& value : action) {
      exact.push_back(
          CentralDifference(&value, [&, last = count - 1] { return Dot(dq, q(last, action)); }));
    }
    EXPECT_LT(RelativeError(daction, exact), 5e-4);
    const std::function<double()> loss = [&, last = count - 1] {
      return Dot(dq, q(last, action_));
    };
    ExpectGradients(&encoder, &network, loss);
    if (count == 1) {
      ExpectGradients(&critic, &network, loss);
    } else {
      for (const float value : GradientOf(critic.parameters(), "critic.q1.layer0.weight")) {
        ASSERT_EQ(value, 0.f);
      }
    }
  }
}

TEST_P(ModulesTest, ATargetFollowsAnyModuleByTheShareAsked) {
  EncoderModule online(PlanEncoder(network_, spec_), Use::kTraining, context_);
  EncoderModule target(PlanEncoder(network_, spec_, "target_encoder"), Use::kInference, context_);
  Start(&online, 1);
  CopyParameters(online, &target);
  const auto features = [&](EncoderModule* encoder) {
    encoder->Forward(HostArray(frames_), Statistics::kRunning);
    return ReadMemory(OnHost(encoder->features()).values());
  };
  EXPECT_EQ(features(&target), features(&online));

  const float before = target.parameters().values()[0];
  Start(&online, 2);
  MoveTowards(0.25f, online, &target);
  EXPECT_FLOAT_EQ(target.parameters().values()[0],
                  before + 0.25f * (online.parameters().values()[0] - before));
  EXPECT_NE(features(&target), features(&online));
  MoveTowards(1.f, online, &target);
  EXPECT_THAT(features(&target), testing::Pointwise(testing::FloatNear(5e-2f), features(&online)));
}

// Not as a moving average of a moving average, which would lag behind the weights it belongs to.
TEST_P(ModulesTest, ATargetTakesRunningStatisticsWhole) {
  NetworkConfig network = network_;
  network.encoder = "resnet18";
  network.initialisation = "pytorch";  // fast
  network.filters.clear();
  network.strides.clear();
  EncoderModule online(PlanEncoder(network, spec_), Use::kTraining, context_);
  EncoderModule target(PlanEncoder(network, spec_, "target_encoder"), Use::kInference, context_);
  Start(&online, 1);
  Start(&target, 2);
  const auto number = [](Module* module, const std::string& name) {
    return module->parameters().Find(name).value()[3];
  };
  const float before = number(&target, "target_encoder.bn1.weight");
  MoveTowards(0.25f, online, &target);
  for (const char* name : {"bn1.running_mean", "layer4.1.bn2.running_var"}) {
    EXPECT_EQ(number(&target, std::string("target_encoder.") + name),
              number(&online, std::string("encoder.") + name));
  }
  EXPECT_FLOAT_EQ(number(&target, "target_encoder.bn1.weight"),
                  before + 0.25f * (number(&online, "encoder.bn1.weight") - before));
}

INSTANTIATE_PRECISIONS(ModulesTest);

}  // namespace
}  // namespace shoal::nn
