// Encoder, actor and critic against their doubles in double: outputs, and gradients by central
// differences.
#include "common/base/error.h"
#include "common/nn/actor_head.h"
#include "common/nn/critic_heads.h"
#include "tests/common/nn/network_fixture.h"

namespace shoal::nn {
namespace {

using reference::Values;

class NetworksTest : public NetworkTest {
 protected:
  void CompareActor() {
    ActorHead actor(Context(*parameters_, kBatch), network_, spec_, features());
    actor.Refresh();
    actor.Forward(ToFloats(vector_).data());
    const auto exact = reference_->Actor(kBatch, features_, vector_);
    const size_t n = size_t(kBatch) * spec_.action_size;
    EXPECT_LT(RelativeError({actor.mean(), n}, exact.mean), Tolerance(GetParam()));
    EXPECT_LT(RelativeError({actor.log_std(), n}, exact.log_std), Tolerance(GetParam()));

    const Values dmean = RandomValues(n, 6), dlog_std = RandomValues(n, 7);
    actor.Backward(ToFloats(dmean).data(), ToFloats(dlog_std).data());
    ExpectGradients("actor.", [&] {
      const auto gaussian = reference_->Actor(kBatch, features_, vector_);
      return Dot(dmean, gaussian.mean) + Dot(dlog_std, gaussian.log_std);
    });
  }

  void CompareCritic() {
    CriticHeads critic(Context(*parameters_, kBatch), "critic", network_, spec_, features(),
                       encoder_ ? encoder_->features_gradient() : dnnl::memory());
    critic.Refresh();
    critic.ForwardObservation(ToFloats(vector_).data());
    critic.ForwardAction(ToFloats(action_).data());
    const auto exact = reference_->Critic("critic", kBatch, features_, vector_, action_);
    EXPECT_LT(RelativeError({critic.q(0), kBatch}, exact.q1), Tolerance(GetParam()));
    EXPECT_LT(RelativeError({critic.q(1), kBatch}, exact.q2), Tolerance(GetParam()));

    const Values dq1 = RandomValues(kBatch, 6), dq2 = RandomValues(kBatch, 7);
    const auto loss = [&](const Values& features) {
      const auto q = reference_->Critic("critic", kBatch, features, vector_, action_);
      return Dot(dq1, q.q1) + Dot(dq2, q.q2);
    };
    std::vector<float> daction(action_.size());
    critic.BackwardAction(ToFloats(dq1).data(), ToFloats(dq2).data(), daction.data());
    for (const float gradient : GradientOf(*parameters_, "critic.q1.output.weight")) {
      ASSERT_EQ(gradient, 0.f);  // the action's gradient alone was asked for
    }
    Values exact_daction;
    for (double& value : action_) {
      exact_daction.push_back(CentralDifference(&value, [&] { return loss(features_); }));
    }
    EXPECT_LT(RelativeError(daction, exact_daction), GradientTolerance());

    critic.Backward(ToFloats(dq1).data(), ToFloats(dq2).data());
    ExpectGradients("critic.", [&] { return loss(features_); });
    if (!encoder_) return;
    encoder_->Backward();
    ExpectGradients("encoder.", [&] { return loss(reference_->Features(kBatch, frames_.data())); });
  }
};

TEST_P(NetworksTest, FeaturesAgreeWithTheReferenceInRowMajorOrder) {
  Build(/*pixels=*/true);
  EXPECT_LT(
      RelativeError(ReadMemory(encoder_->features()), reference_->Features(kBatch, frames_.data())),
      Tolerance(GetParam()));
}

TEST_P(NetworksTest, ActorAgreesWithTheReferenceOnPixelsAndVector) {
  Build(/*pixels=*/true);
  CompareActor();
}

TEST_P(NetworksTest, ActorAgreesWithTheReferenceOnTheVectorAlone) {
  Build(/*pixels=*/false);
  CompareActor();
}

TEST_P(NetworksTest, CriticAgreesWithTheReferenceOnPixelsAndVector) {
  Build(/*pixels=*/true);
  CompareCritic();
}

TEST_P(NetworksTest, CriticAgreesWithTheReferenceOnTheVectorAlone) {
  Build(/*pixels=*/false);
  CompareCritic();
}

// In f32 alone: without LayerNorm a unit that bf16 puts on the other side of its ReLU weighs too
// much to compare.
class NetworksF32Test : public NetworksTest {};

TEST_P(NetworksF32Test, CriticAgreesWithTheReferenceWithoutLayerNormInTheMlps) {
  NetworkConfig network = OddNetwork();
  network.layer_norm = false;
  Build(/*pixels=*/true, network);
  CompareCritic();
}

TEST_P(NetworksTest, CriticAgreesWithTheReferenceWithoutHiddenLayers) {
  NetworkConfig network = OddNetwork();
  network.hidden = {};
  Build(/*pixels=*/true, network);
  CompareCritic();
}

INSTANTIATE_PRECISIONS(NetworksTest);
INSTANTIATE_TEST_SUITE_P(Precision, NetworksF32Test, testing::Values(Precision::kF32));

TEST(NetworkParameters, DefaultNetworkIsTheOneOfTheTrial) {
  ObservationSpec spec;
  spec.channels = 6;
  spec.height = spec.width = 84;
  spec.action_size = 3;
  const NetworkConfig network;
  std::vector<std::string> names;
  for (const ParameterShape& shape : AllShapes(network, spec)) {
    std::string text = shape.name;
    for (const int64_t size : shape.shape) text += fmt::format(" {}", size);
    names.push_back(text);
  }
  EXPECT_EQ(names[0], "encoder.conv0.weight 32 6 3 3");
  EXPECT_EQ(names[4], "encoder.conv2.weight 32 32 3 3");
  EXPECT_EQ(names[6], "actor.trunk.weight 50 2048");
  EXPECT_EQ(names[10], "actor.mlp.layer0.weight 256 50");
  EXPECT_EQ(names[18], "actor.mlp.output.weight 6 256");
  EXPECT_EQ(names[24], "critic.q1.layer0.weight 256 53");
  EXPECT_EQ(names.back(), "critic.q2.output.bias 1");
  EXPECT_EQ(names.size(), 44u);
}

TEST(NetworkParameters, ImagesTooSmallForTheConvolutionsAreBadUsage) {
  ObservationSpec spec;
  spec.channels = 3;
  spec.height = spec.width = 20;  // pooled 10, then 4, then 2
  EXPECT_THROW(ConvSizes(NetworkConfig(), spec), Error);
}

}  // namespace
}  // namespace shoal::nn
