// SPDX-License-Identifier: Apache-2.0
#include "common/nn/network_plan.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>

#include "common/base/error.h"
#include "common/config/config_io.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/encoders/encoder_kind.h"
#include "common/nn/parameter_set.h"
#include "common/nn/plan_text.h"

namespace shoal::nn {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;

ObservationSpec Images(int height, int width) {
  ObservationSpec spec;
  spec.cameras = {"front", "side"};
  spec.channels = 6;
  spec.height = height;
  spec.width = width;
  spec.action_size = 3;
  return spec;
}

// "NAME SHAPE" of every parameter.
std::vector<std::string> Texts(const std::vector<ParameterSpec>& parameters) {
  std::vector<std::string> texts;
  texts.reserve(parameters.size());
  for (const ParameterSpec& parameter : parameters) {
    texts.push_back(fmt::format("{} {}", parameter.name, fmt::join(parameter.shape, " ")));
  }
  return texts;
}

NetworkPlan EncoderPlan(const std::string& kind, int height = 84, int width = 84) {
  NetworkConfig network;
  network.encoder = kind;
  return PlanEncoder(network, Images(height, width));
}

TEST(NetworkPlan, ConvolutionsShrinkTheirMapByKernelStrideAndPadding) {
  NetworkPlan plan({5, 23, 18});
  plan.Add(NetworkPlan::Convolution{
      .name = "a", .key = "k", .filters = 7, .kernel = 7, .stride = 2, .padding = 3});
  EXPECT_EQ(plan.output(), (MapShape{7, 12, 9}));
  plan.Add(
      NetworkPlan::Convolution{.name = "b", .key = "k", .filters = 4, .kernel = 4, .stride = 3});
  EXPECT_EQ(plan.output(), (MapShape{4, 3, 2}));
  plan.Add(NetworkPlan::Linear{.name = "c", .key = "k", .outputs = 9, .layer_norm = true});
  EXPECT_EQ(plan.output(), (MapShape{9, 1, 1}));
  EXPECT_THAT(Texts(plan.Parameters()),
              ElementsAre("a.weight 7 5 7 7", "a.bias 7", "b.weight 4 7 4 4", "b.bias 4",
                          "c.weight 9 24", "c.bias 9", "c.norm.weight 9", "c.norm.bias 9"));
}

TEST(NetworkPlan, LayersMayReadAnEarlierOneAndAddAnother) {
  NetworkPlan plan({3, 9, 8});
  const NetworkPlan::Convolution layer{.name = "a",
                                       .key = "k",
                                       .filters = 4,
                                       .kernel = 3,
                                       .stride = 2,
                                       .padding = 1,
                                       .bias = false,
                                       .batch_norm = "a.bn"};
  EXPECT_EQ(plan.Add(layer), 0);
  NetworkPlan::Convolution same = layer;
  same.name = "b";
  same.stride = 1;
  same.skip = 0;
  EXPECT_EQ(plan.Add(same), 1);
  NetworkPlan::Convolution around = layer;
  around.name = "c";
  around.source = 0;
  EXPECT_EQ(plan.Add(around), 2);
  EXPECT_EQ(plan.layers()[0].source, kNoLayer);
  EXPECT_EQ(plan.layers()[1].source, 0);
  EXPECT_EQ(plan.layers()[1].skip, 0);
  EXPECT_EQ(plan.layers()[2].source, 0);
  EXPECT_EQ(plan.layers()[2].input, (MapShape{4, 5, 4}));
  EXPECT_EQ(plan.output(), (MapShape{4, 3, 2}));
  EXPECT_THAT(Texts(plan.layers()[0].Parameters()),
              ElementsAre("a.weight 4 3 3 3", "a.bn.weight 4", "a.bn.bias 4", "a.bn.running_mean 4",
                          "a.bn.running_var 4"));
  const std::vector<ParameterSpec> parameters = plan.layers()[0].Parameters();
  EXPECT_FALSE(parameters[2].statistic);
  EXPECT_TRUE(parameters[3].statistic && parameters[4].statistic);
  EXPECT_EQ(parameters[4].start.kind, Start::Kind::kOnes);

  EXPECT_EQ(plan.Add(NetworkPlan::MaxPool{.name = "max", .key = "k", .kernel = 2, .stride = 1}), 3);
  EXPECT_EQ(plan.output(), (MapShape{4, 2, 1}));
  plan.Add(NetworkPlan::AveragePool{.name = "mean", .key = "k", .height = 6, .width = 5});
  EXPECT_EQ(plan.output(), (MapShape{4, 6, 5}));
  EXPECT_TRUE(plan.layers()[3].Parameters().empty() && plan.layers()[4].Parameters().empty());
  plan = NetworkPlan({1, 4, 2});
  EXPECT_THAT(
      [&] { plan.Add(NetworkPlan::MaxPool{.name = "m", .key = "k", .kernel = 3, .stride = 2}); },
      ThrowsMessage<Error>(AllOf(HasSubstr("4x2"), HasSubstr("3x3 window of m"))));
}

TEST(NetworkPlan, AMapSmallerThanTheKernelIsBadUsageUnlessPadded) {
  NetworkPlan plan({1, 5, 9});
  const NetworkPlan::Convolution large{
      .name = "conv4", .key = "network.filters", .filters = 1, .kernel = 6, .stride = 1};
  EXPECT_THAT([&] { plan.Add(large); },
              ThrowsMessage<Error>(AllOf(HasSubstr("network.filters"), HasSubstr("5x9"),
                                         HasSubstr("6x6"), HasSubstr("conv4"))));
  NetworkPlan::Convolution padded = large;
  padded.padding = 1;
  plan.Add(padded);
  EXPECT_EQ(plan.output(), (MapShape{1, 2, 6}));
}

TEST(NetworkPlan, OrthogonalGainsAreTheRootOfTwoForConvolutionsAndOneForLinears) {
  const auto parameters = PolicyParameters({}, Images(84, 84));
  EXPECT_EQ(parameters[0].start.kind, Start::Kind::kOrthogonal);
  EXPECT_DOUBLE_EQ(parameters[0].start.scale, std::sqrt(2.0));
  EXPECT_EQ(parameters[1].start.kind, Start::Kind::kZeros);
  EXPECT_EQ(parameters[6].name, "actor.trunk.weight");
  EXPECT_DOUBLE_EQ(parameters[6].start.scale, 1.0);
  EXPECT_EQ(parameters[8].name, "actor.trunk.norm.weight");
  EXPECT_EQ(parameters[8].start.kind, Start::Kind::kOnes);
}

TEST(NetworkPlan, PyTorchsBoundsAreOneOverTheRootOfAnOutputsInputs) {
  NetworkConfig network;
  network.encoder = "nature";
  network.initialisation = "pytorch";
  const auto parameters = PolicyParameters(network, Images(84, 84));
  for (const size_t i : {size_t{0}, size_t{1}}) {  // weight and bias of 6 channels, 8x8
    EXPECT_EQ(parameters[i].start.kind, Start::Kind::kUniform) << parameters[i].name;
    EXPECT_DOUBLE_EQ(parameters[i].start.scale, 1 / std::sqrt(6 * 8 * 8));
  }
  EXPECT_EQ(parameters[6].name, "actor.trunk.weight");
  EXPECT_DOUBLE_EQ(parameters[6].start.scale, 1 / std::sqrt(3136.0));
  EXPECT_DOUBLE_EQ(parameters[7].start.scale, 1 / std::sqrt(3136.0));
}

TEST(EncoderKinds, HaveTheMapsOfTheirPapers) {
  EXPECT_EQ(EncoderPlan("compact").output(), (MapShape{32, 8, 8}));
  EXPECT_EQ(EncoderPlan("drq").output(), (MapShape{32, 35, 35}));
  EXPECT_EQ(EncoderPlan("mrq").output(), (MapShape{32, 7, 7}));
  EXPECT_EQ(EncoderPlan("nature").output(), (MapShape{64, 7, 7}));
  EXPECT_THAT(Texts(EncoderPlan("nature").Parameters()),
              ElementsAre("encoder.conv0.weight 32 6 8 8", "encoder.conv0.bias 32",
                          "encoder.conv1.weight 64 32 4 4", "encoder.conv1.bias 64",
                          "encoder.conv2.weight 64 64 3 3", "encoder.conv2.bias 64"));
}

TEST(EncoderKinds, TorchvisionsHaveItsSizes) {
  const auto trained = [](const NetworkPlan& plan) {
    int64_t sum = 0;
    for (const ParameterSpec& parameter : plan.Parameters()) {
      int64_t numbers = 1;
      for (const int64_t size : parameter.shape) numbers *= size;
      sum += parameter.statistic ? 0 : numbers;
    }
    return sum;
  };
  NetworkConfig network;
  ObservationSpec spec = Images(224, 224);
  spec.channels = 3;
  network.encoder = "resnet18";
  EXPECT_EQ(PlanEncoder(network, spec).output(), (MapShape{512, 1, 1}));
  EXPECT_EQ(trained(PlanEncoder(network, spec)), 11'689'512 - (512 * 1000 + 1000));  // but fc
  network.encoder = "alexnet";
  EXPECT_EQ(PlanEncoder(network, spec).output(), (MapShape{256, 6, 6}));
  EXPECT_EQ(trained(PlanEncoder(network, spec)), 2'469'696);
  EXPECT_EQ(EncoderPlan("alexnet", 84, 84).output(), (MapShape{256, 6, 6}));
}

TEST(EncoderKinds, ResnetStartsAsTorchvisionsWithPyTorchsInitialisation) {
  NetworkConfig network;
  network.encoder = "resnet18";
  EXPECT_EQ(PlanEncoder(network, Images(84, 84)).Parameters()[0].start.kind,
            Start::Kind::kOrthogonal);
  network.initialisation = "pytorch";
  const Start start = PlanEncoder(network, Images(84, 84)).Parameters()[0].start;
  EXPECT_EQ(start.kind, Start::Kind::kNormal);
  EXPECT_DOUBLE_EQ(start.scale, std::sqrt(2.0 / (64 * 7 * 7)));  // outputs, fan_out
}

TEST(EncoderKinds, AreTheWordsThatTheKeyTakes) {
  for (const EncoderKind& kind : EncoderKinds()) {
    Config config;
    ApplyAssignments({fmt::format("network.encoder={}", kind.name)}, &config);
    EXPECT_EQ(FindEncoderKind(config.network.encoder).name, kind.name);
  }
  EXPECT_THAT(
      [] { FindEncoderKind("resnet"); },
      ThrowsMessage<Error>(
          AllOf(HasSubstr("network.encoder = resnet"),
                HasSubstr("compact | drq | mrq | nature | resnet18 | alexnet | spatial_softmax"))));
}

TEST(EncoderKinds, EachFitsThePresetForPixels) {
  for (const EncoderKind& kind : EncoderKinds()) {
    Config config = LoadPreset("fetch-reach-drq");
    ApplyAssignments({fmt::format("network.encoder={}", kind.name)}, &config);
    EXPECT_NO_THROW(PlanEncoder(config.network, Images(84, 84))) << kind.name;
  }
}

TEST(EncoderKinds, ImagesTooSmallAreRefusedNamingTheSmallestThatFit) {
  EXPECT_THAT([] { EncoderPlan("nature", 35, 84); },
              ThrowsMessage<Error>(AllOf(HasSubstr("network.encoder = nature"), HasSubstr("35x84"),
                                         HasSubstr("at least 36x36"))));
  EXPECT_NO_THROW(EncoderPlan("nature", 36, 36));
  EXPECT_THAT([] { EncoderPlan("drq", 14, 14); },
              ThrowsMessage<Error>(HasSubstr("at least 15x15")));
  EXPECT_NO_THROW(EncoderPlan("drq", 15, 15));
  EXPECT_THAT([] { EncoderPlan("mrq", 30, 84); },
              ThrowsMessage<Error>(HasSubstr("at least 31x31")));
  EXPECT_NO_THROW(EncoderPlan("mrq", 31, 31));
  EXPECT_THAT([] { EncoderPlan("compact", 20, 20); },
              ThrowsMessage<Error>(HasSubstr("at least 22x22")));
  EXPECT_NO_THROW(EncoderPlan("compact", 22, 22));
  EXPECT_THAT([] { EncoderPlan("alexnet", 62, 84); },
              ThrowsMessage<Error>(AllOf(HasSubstr("network.encoder = alexnet"), HasSubstr("62x84"),
                                         HasSubstr("at least 63x63"))));
  EXPECT_NO_THROW(EncoderPlan("alexnet", 63, 63));
  EXPECT_THAT([] { EncoderPlan("spatial_softmax", 12, 84); },
              ThrowsMessage<Error>(HasSubstr("at least 14x14")));
  EXPECT_EQ(EncoderPlan("spatial_softmax", 14, 14).output(), (MapShape{32, 1, 2}));
  EXPECT_THAT([] { EncoderPlan("spatial_softmax", 84, 63); },
              ThrowsMessage<Error>(AllOf(HasSubstr("network.encoder = spatial_softmax"),
                                         HasSubstr("even sides, not 84x63"))));
  EXPECT_NO_THROW(EncoderPlan("resnet18", 8, 8));
}

TEST(EncoderKinds, CompactTakesItsKeysAndChecksThem) {
  NetworkConfig network;
  network.filters = {8, 4};
  network.strides = {1, 3};
  network.pool = 3;
  EXPECT_EQ(PlanEncoder(network, Images(84, 81)).output(), (MapShape{4, 8, 8}));
  network.strides = {};
  EXPECT_THAT(
      [&] { PlanEncoder(network, Images(84, 81)); },
      ThrowsMessage<Error>(HasSubstr("network.filters has 2 entries and network.strides 3")));
  network = {};
  network.pool = 5;
  EXPECT_THAT([&] { PlanEncoder(network, Images(84, 84)); },
              ThrowsMessage<Error>(AllOf(HasSubstr("network.pool = 5"), HasSubstr("84x84"))));
}

TEST(ActorCriticPlan, DefaultNetworkHasTheseParameters) {
  std::vector<ParameterSpec> parameters = PolicyParameters({}, Images(84, 84));
  Append(PlanCritic({}, Images(84, 84), "critic").Parameters(), &parameters);
  const std::vector<std::string> texts = Texts(parameters);
  ASSERT_EQ(texts.size(), 44u);
  EXPECT_EQ(texts[0], "encoder.conv0.weight 32 6 3 3");
  EXPECT_EQ(texts[4], "encoder.conv2.weight 32 32 3 3");
  EXPECT_EQ(texts[6], "actor.trunk.weight 50 2048");
  EXPECT_EQ(texts[10], "actor.mlp.layer0.weight 256 50");
  EXPECT_EQ(texts[18], "actor.mlp.output.weight 6 256");
  EXPECT_EQ(texts[24], "critic.q1.layer0.weight 256 53");
  EXPECT_EQ(texts.back(), "critic.q2.output.bias 1");
}

// A Q function of three numbers and two actions, with one residual block.
NetworkPlan PlanWithABlock(int width) {
  NetworkConfig network;
  network.hidden = {width};
  network.blocks = 1;
  ObservationSpec spec;
  spec.blocks = {{"joints", 3}};
  spec.action_size = 2;
  return PlanCritic(network, spec, "critic").mlps[0];
}

TEST(ActorCriticPlan, ResidualBlocksFollowOneLinearLayer) {
  const NetworkPlan mlp = PlanWithABlock(8);
  std::vector<std::string> lines;
  lines.reserve(mlp.layers().size());
  for (const LayerPlan& layer : mlp.layers()) lines.push_back(PlanLine(layer));
  EXPECT_THAT(
      lines,
      ElementsAre("critic.q1.layer0: linear, 5x1x1 to 8x1x1, bias",
                  "critic.q1.block0.norm: layer norm of layer 0, 8x1x1 to 8x1x1, bias",
                  "critic.q1.block0.layer0: linear of layer 1, 8x1x1 to 32x1x1, bias, relu",
                  "critic.q1.block0.layer1: linear of layer 2, 32x1x1 to 8x1x1, bias, plus layer 0",
                  "critic.q1.norm: layer norm of layer 3, 8x1x1 to 8x1x1, bias",
                  "critic.q1.output: linear of layer 4, 8x1x1 to 1x1x1, bias"));
  EXPECT_THAT(Texts(mlp.Parameters()),
              ElementsAre("critic.q1.layer0.weight 8 5", "critic.q1.layer0.bias 8",
                          "critic.q1.block0.norm.weight 8", "critic.q1.block0.norm.bias 8",
                          "critic.q1.block0.layer0.weight 32 8", "critic.q1.block0.layer0.bias 32",
                          "critic.q1.block0.layer1.weight 8 32", "critic.q1.block0.layer1.bias 8",
                          "critic.q1.norm.weight 8", "critic.q1.norm.bias 8",
                          "critic.q1.output.weight 1 8", "critic.q1.output.bias 1"));
}

// The paper's blocks start with weights of variance 2 / inputs.
TEST(ActorCriticPlan, WeightsOfResidualBlocksStartWithTheVarianceOfHe) {
  ParameterSet parameters(PlanWithABlock(64).Parameters(), ParameterSet::Use::kTraining);
  parameters.Initialise(1);
  for (const auto& [name, inputs] : {std::pair("layer0", 64), std::pair("layer1", 256)}) {
    const Parameter weight = parameters.Find(std::string("critic.q1.block0.") + name + ".weight");
    double squares = 0;
    for (int i = 0; i < 64 * 256; ++i) squares += double(weight.value()[i]) * weight.value()[i];
    EXPECT_NEAR(squares / (64 * 256), 2.0 / inputs, 1e-6) << name;
  }
}

TEST(ActorCriticPlan, NatureHasALinearReluTrunkOf512UnlessToldOtherwise) {
  NetworkConfig network;
  network.encoder = "nature";
  const HeadPlan nature = PlanActor(network, Images(84, 84));
  EXPECT_THAT(Texts(nature.trunk.Parameters()),
              ElementsAre("actor.trunk.weight 512 3136", "actor.trunk.bias 512"));
  EXPECT_EQ(nature.trunk.layers()[0].activation, Activation::kRelu);
  network.trunk = "tanh";
  network.features = 256;
  const HeadPlan other = PlanActor(network, Images(84, 84));
  EXPECT_EQ(other.trunk.Parameters().size(), 4u);
  EXPECT_EQ(other.trunk_columns(), 256);
  EXPECT_EQ(other.trunk.layers()[0].activation, Activation::kTanh);
}

TEST(ActorCriticPlan, WithoutPixelsTheVectorAloneEnters) {
  ObservationSpec spec;
  spec.blocks = {{"goal", 3}, {"joints", 4}};
  spec.action_size = 2;
  EXPECT_TRUE(PlanEncoder({}, spec).layers().empty());
  const HeadPlan critic = PlanCritic({}, spec, "critic", /*count=*/3);
  EXPECT_EQ(critic.trunk_columns(), 0);
  ASSERT_EQ(critic.mlps.size(), 3u);
  EXPECT_EQ(Texts(critic.mlps[2].Parameters())[0], "critic.q3.layer0.weight 256 9");
  const HeadPlan actor = PlanActor({}, spec, ActorOutput::kDeterministic);
  EXPECT_EQ(actor.mlps[0].output().channels, 2);
}

}  // namespace
}  // namespace shoal::nn
