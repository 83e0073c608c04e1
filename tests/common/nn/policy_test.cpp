// SPDX-License-Identifier: Apache-2.0
#include "common/nn/policy.h"

#include <gmock/gmock.h>

#include <cmath>

#include "common/base/error.h"
#include "common/nn/actor_head.h"
#include "tests/common/nn/network_fixture.h"

namespace shoal::nn {
namespace {

class PolicyTest : public NetworkTest {
 protected:
  struct Output {
    std::vector<float> mean, log_std;
  };

  TensorMap Tensors() const {
    TensorMap tensors;
    parameters_->Export(parameters_->values(), "", &tensors);
    return tensors;
  }

  Output Run(Policy* policy, int batch) const {
    const PolicyOutput result = policy->Forward(batch, frames_.data(), ToFloats(vector_).data());
    return {{result.mean.begin(), result.mean.end()},
            {result.log_std.begin(), result.log_std.end()}};
  }
};

TEST_P(PolicyTest, ForwardIsTheTrainedActorsForward) {
  for (const bool pixels : {true, false}) {
    Build(pixels);
    ActorHead actor(Context(*parameters_, kBatch), PlanActor(network_, spec_), features(), {});
    actor.Refresh();
    actor.Forward(ToFloats(vector_).data());
    Policy policy(network_, spec_, GetParam(), kBatch);
    policy.Load(Tensors(), "test");
    const Output output = Run(&policy, kBatch);
    EXPECT_EQ(output.mean, std::vector<float>(actor.mean(), actor.mean() + kBatch * 3));
    EXPECT_EQ(output.log_std, std::vector<float>(actor.log_std(), actor.log_std() + kBatch * 3));
  }
}

TEST_P(PolicyTest, EveryBatchSizeGivesTheReferencesResult) {
  Build(/*pixels=*/true);
  Policy policy(network_, spec_, GetParam(), kBatch);
  policy.Load(Tensors(), "test");
  const auto exact =
      reference_->Actor(kBatch, reference_->Features(kBatch, frames_.data()), vector_);
  for (int batch = 1; batch <= kBatch; ++batch) {
    const Output output = Run(&policy, batch);
    const auto first = [&](const reference::Values& values) {
      return reference::Values(values.begin(), values.begin() + batch * 3);
    };
    // Twice the tolerance of a head, because the encoder rounds too.
    EXPECT_LT(RelativeError(output.mean, first(exact.mean)), 2 * Tolerance(GetParam())) << batch;
    EXPECT_LT(RelativeError(output.log_std, first(exact.log_std)), 2 * Tolerance(GetParam()));
  }
}

TEST_P(PolicyTest, LoadReachesBatchSizesUsedBefore) {
  Build(/*pixels=*/true);
  Policy policy(network_, spec_, GetParam(), kBatch), fresh(network_, spec_, GetParam(), kBatch);
  policy.Load(Tensors(), "test");
  Run(&policy, 2);
  TensorMap changed = Tensors();
  for (int64_t i = 0; i < parameters_->size(); ++i) parameters_->values()[i] *= 0.5f;
  changed = Tensors();
  policy.Load(changed, "test");
  fresh.Load(changed, "test");
  for (const int batch : {2, kBatch}) {
    EXPECT_EQ(Run(&policy, batch).mean, Run(&fresh, batch).mean) << batch;
  }
}

TEST_P(PolicyTest, TakesWeightsRoundedForTheWire) {
  Build(/*pixels=*/true);
  Policy policy(network_, spec_, GetParam(), kBatch), rounded(network_, spec_, GetParam(), kBatch);
  policy.Load(Tensors(), "test");
  rounded.Load(ToBf16(Tensors()), "test");
  const std::vector<float> mean = Run(&policy, kBatch).mean;
  EXPECT_LT(RelativeError(Run(&rounded, kBatch).mean, ToDoubles(mean)),
            Tolerance(Precision::kBf16));
}

// One whose layers fill the blocks of the CPU's layouts; OddNetwork's do not.
NetworkConfig EvenNetwork() {
  NetworkConfig network;
  network.filters = {32, 16};
  network.strides = {2, 1};
  network.features = 64;
  network.hidden = {128, 64};
  return network;
}

// Equal in every bit: values that arrived as bf16 are neither changed nor rounded again.
TEST_P(PolicyTest, ActsByRoundedWeightsAsByTheSameNumbersInF32) {
  for (const NetworkConfig& network : {OddNetwork(), EvenNetwork()}) {
    for (const bool pixels : {true, false}) {
      Build(pixels, network);
      const TensorMap rounded = ToBf16(Tensors());
      // The layers as they are trained, of f32 parameters that were widened from bf16.
      parameters_->Import(rounded, "", "test", parameters_->values());
      const std::vector<float> vector = ToFloats(vector_);
      if (encoder_) {
        encoder_->Refresh();
        encoder_->Forward(frames_.data(), Statistics::kBatch);
      }
      ActorHead actor(Context(*parameters_, kBatch), PlanActor(network_, spec_), features(), {});
      actor.Refresh();
      actor.Forward(vector.data());
      const std::vector<float> mean(actor.mean(), actor.mean() + kBatch * 3);
      const std::vector<float> log_std(actor.log_std(), actor.log_std() + kBatch * 3);

      Policy of_rounded(network_, spec_, GetParam(), kBatch);
      Policy of_widened(network_, spec_, GetParam(), kBatch);
      of_rounded.Load(rounded, "test");
      of_widened.Load(Tensors(), "test");
      for (Policy* policy : {&of_rounded, &of_widened}) {
        const Output output = Run(policy, kBatch);
        EXPECT_EQ(output.mean, mean);
        EXPECT_EQ(output.log_std, log_std);
      }
    }
  }
}

TEST_P(PolicyTest, SharesAFilesBytesUntilTheNextOnes) {
  Build(/*pixels=*/true);
  Policy policy(network_, spec_, GetParam(), kBatch), fresh(network_, spec_, GetParam(), kBatch);
  fresh.Load(ToBf16(Tensors()), "test");
  auto file = std::make_shared<const std::string>(WriteSafetensors(ToBf16(Tensors()), {}));
  const std::weak_ptr<const std::string> kept = file;
  policy.Load(SharedBytes(file, *file), "test");
  file.reset();
  EXPECT_FALSE(kept.expired());
  EXPECT_EQ(Run(&policy, kBatch).mean, Run(&fresh, kBatch).mean);
  EXPECT_THROW(policy.Load(SharedBytes("no file"), "test"), Error);
  EXPECT_EQ(Run(&policy, 2).mean, Run(&fresh, 2).mean) << "a batch size that is new";
  policy.Load(Tensors(), "test");
  EXPECT_TRUE(kept.expired());
}

// A file may have any alignment in memory, and its tensors any offset.
TEST_P(PolicyTest, TakesTensorsAtOddAddresses) {
  Build(/*pixels=*/true);
  for (const TensorMap& tensors : {Tensors(), ToBf16(Tensors())}) {
    Policy policy(network_, spec_, GetParam(), kBatch), even(network_, spec_, GetParam(), kBatch);
    even.Load(tensors, "test");
    const auto shifted = std::make_shared<const std::string>("x" + WriteSafetensors(tensors, {}));
    policy.Load(SharedBytes(shifted, std::string_view(*shifted).substr(1)), "test");
    EXPECT_EQ(Run(&policy, kBatch).mean, Run(&even, kBatch).mean);
  }
}

TEST_P(PolicyTest, KeepsItsWeightsWhenNewOnesAreRefused) {
  Build(/*pixels=*/true);
  Policy policy(network_, spec_, GetParam(), kBatch);
  policy.Load(Tensors(), "test");
  const std::vector<float> before = Run(&policy, kBatch).mean;
  std::fill_n(parameters_->values(), parameters_->size(), 0.f);
  TensorMap incomplete = Tensors();
  incomplete.erase("actor.mlp.output.bias");
  EXPECT_THAT([&] { policy.Load(incomplete, "weights 12"); },
              testing::ThrowsMessage<Error>(testing::AllOf(
                  testing::HasSubstr("weights 12"), testing::HasSubstr("actor.mlp.output.bias"))));
  EXPECT_EQ(Run(&policy, kBatch).mean, before);
}

// Two millimetres of a goal at 1.34 m: between 1 and 2 neighbouring bf16 are 7.8 mm apart.
TEST_P(PolicyTest, TellsGoalsTwoMillimetresApart) {
  NetworkConfig network = OddNetwork();
  network.hidden = {256, 256};
  for (const bool pixels : {true, false}) {
    Build(pixels, network);
    Policy policy(network_, spec_, GetParam(), kBatch);
    policy.Load(Tensors(), "test");
    std::vector<float> mean;
    for (int millimetres = 0; millimetres < 16; millimetres += 2) {
      for (size_t b = 0; b < size_t(kBatch); ++b) vector_[b * 5] = 1.340 + 0.001 * millimetres;
      const std::vector<float> before = std::exchange(mean, Run(&policy, kBatch).mean);
      for (size_t i = 0; i < before.size(); ++i) {
        EXPECT_NE(before[i], mean[i]) << "component " << i << ", goal " << vector_[0] << " m";
      }
    }
  }
}

// The vector columns of the first layer get the vector to f32's last digits.
TEST_P(PolicyTest, ComputesAVectorsFirstLayerInF32) {
  NetworkConfig network = OddNetwork();
  network.hidden = {};  // the first layer is all there is
  Build(/*pixels=*/false, network);
  Policy policy(network_, spec_, GetParam(), kBatch);
  policy.Load(Tensors(), "test");
  EXPECT_LT(
      RelativeError(Run(&policy, kBatch).mean, reference_->Actor(kBatch, features_, vector_).mean),
      Tolerance(Precision::kF32));
}

// The weights determine the kind of policy.
TEST_P(PolicyTest, ADeterministicPolicyHasNoDeviation) {
  Build(/*pixels=*/true);
  const ActorPlan plan = PlanActor(network_, spec_, ActorOutput::kDeterministic);
  ParameterSet actor_parameters(plan.Parameters(), ParameterSet::Use::kInference);
  actor_parameters.Initialise(9);
  TensorMap tensors = Tensors();
  actor_parameters.Export(&tensors);
  ActorHead actor(Context(actor_parameters, kBatch, /*training=*/false), plan, features(), {});
  actor.Refresh();
  actor.Forward(ToFloats(vector_).data());

  Policy policy(network_, spec_, GetParam(), kBatch);
  policy.Load(tensors, "test");
  const Output output = Run(&policy, kBatch);
  EXPECT_TRUE(output.log_std.empty());
  EXPECT_EQ(output.mean, std::vector<float>(actor.mean(), actor.mean() + kBatch * 3));

  // A Gaussian one again; then a deterministic one that is incomplete changes nothing.
  policy.Load(Tensors(), "test");
  const Output gaussian = Run(&policy, kBatch);
  EXPECT_EQ(gaussian.log_std.size(), gaussian.mean.size());
  tensors.erase("actor.trunk.bias");
  EXPECT_THROW(policy.Load(tensors, "test"), Error);
  EXPECT_EQ(Run(&policy, kBatch).log_std, gaussian.log_std);
}

TEST(MeanActions, AreSquashedOrClipped) {
  const std::vector<float> mean{0.5f, -3, 2, 0};
  std::vector<float> actions(4);
  MeanActions({.mean = mean, .log_std = {}}, actions);
  EXPECT_EQ(actions, (std::vector<float>{std::tanh(0.5f), std::tanh(-3.f), std::tanh(2.f), 0}));
  MeanActions({.mean = mean, .log_std = {}, .squashed = false}, actions);
  EXPECT_EQ(actions, (std::vector<float>{0.5f, -1, 1, 0}));
}

TEST(ActorOutputOf, IsWhatTheTensorsSay) {
  TensorMap tensors{{"actor.mlp.output.bias", {"F32", {6}, {}}}};
  EXPECT_EQ(ActorOutputOf(tensors, 3), ActorOutput::kGaussian);
  EXPECT_EQ(ActorOutputOf(tensors, 6), ActorOutput::kDeterministic);
  tensors["actor.log_std"] = {"F32", {6}, {}};
  EXPECT_EQ(ActorOutputOf(tensors, 6), ActorOutput::kUnsquashed);
}

// Statistics of the batch would make an action depend on the other environments of the batch.
TEST_P(PolicyTest, WithBatchNormalisationAnActionDoesNotDependOnTheBatch) {
  NetworkConfig network = OddNetwork();
  network.encoder = "resnet18";
  network.initialisation = "pytorch";  // fast
  network.filters.clear();
  network.strides.clear();
  Build(OddSpec(/*pixels=*/true), network);
  Policy policy(network_, spec_, GetParam(), kBatch);
  policy.Load(Tensors(), "test");
  const std::vector<float> all = Run(&policy, kBatch).mean, one = Run(&policy, 1).mean;
  EXPECT_LT(RelativeError(one, ToDoubles(std::span(all).first(one.size()))), Tolerance(GetParam()));
}

INSTANTIATE_PRECISIONS(PolicyTest);

}  // namespace
}  // namespace shoal::nn
