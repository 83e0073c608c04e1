// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/onnx_policy.h"

#include <gmock/gmock.h>

#include <cstring>

#include "common/nn/encoders/encoder_kind.h"
#include "launch/tools/export/policy_actions.h"
#include "tests/launch/tools/export/random_policy.h"
#include "tests/support/error_message.h"

namespace shoal::launch {
namespace {

using nn::ActorOutput;
using testing::HasSubstr;

std::vector<PolicyKind> AllKinds() {
  std::vector<std::string> encoders{""};
  for (const nn::EncoderKind& kind : nn::EncoderKinds()) encoders.emplace_back(kind.name);
  std::vector<PolicyKind> kinds;
  for (const std::string& encoder : encoders) {
    for (const ActorOutput output :
         {ActorOutput::kGaussian, ActorOutput::kDeterministic, ActorOutput::kUnsquashed}) {
      kinds.push_back({encoder, output, /*normalised=*/output != ActorOutput::kDeterministic});
    }
  }
  return kinds;
}

class OnnxPolicyOfEveryKind : public testing::TestWithParam<PolicyKind> {};

std::string NameOf(const testing::TestParamInfo<PolicyKind>& kind) {
  constexpr const char* kOutputs[] = {"Gaussian", "Deterministic", "Unsquashed"};
  const std::string& encoder = kind.param.encoder;
  return (encoder.empty() ? "vectors" : encoder) + kOutputs[int(kind.param.output)];
}

INSTANTIATE_TEST_SUITE_P(All, OnnxPolicyOfEveryKind, testing::ValuesIn(AllKinds()), NameOf);

TEST_P(OnnxPolicyOfEveryKind, ActsAsThePolicyDoes) {
  const policy::CheckpointPolicy policy = RandomPolicy(GetParam());
  const auto scale = nn::ReadVectorScale(policy.tensors, policy.description.spec.VectorSize(), "");
  const ObservationSet observations = RandomObservations(
      policy.description.spec, scale, GetParam().encoder.empty() ? 40 : 2, /*seed=*/3);
  const OnnxModel model = ReadOnnx(WriteOnnx(PolicyToOnnx(policy)), "test");
  const Agreement agreement =
      Compare(OwnActions(policy, observations),
              OnnxActions(model, policy.description.spec, observations), observations.count);
  EXPECT_LT(agreement.largest_difference, 2e-5);
  EXPECT_GT(agreement.most - agreement.least, 0.1);  // there is something to tell apart
}

TEST(OnnxPolicy, NetworksVariantsAreFollowed) {
  NetworkConfig tanh, elu, blocks;
  tanh.layer_norm = true;
  tanh.activation = "tanh";
  tanh.trunk = "relu";
  elu.activation = elu.trunk = "elu";
  elu.state_hidden = {12, 10};
  blocks.blocks = 2;
  for (const NetworkConfig& network : {tanh, elu, blocks}) {
    for (const char* encoder : {"", "compact"}) {
      const policy::CheckpointPolicy policy = RandomPolicy({encoder}, network);
      const ObservationSet observations =
          RandomObservations(policy.description.spec, {}, 4, /*seed=*/3);
      const Agreement agreement =
          Compare(OwnActions(policy, observations),
                  OnnxActions(PolicyToOnnx(policy), policy.description.spec, observations),
                  observations.count);
      EXPECT_LT(agreement.largest_difference, 2e-5) << network.activation << encoder;
    }
  }
}

TEST(OnnxPolicy, HasTheSpecsInputs) {
  const OnnxModel model = PolicyToOnnx(RandomPolicy({"drq"}));
  const std::vector<OnnxPort> expected{
      {.name = "pixels", .type = OnnxPort::Type::kU8, .shape = {12, 48, 44}},
      {.name = "grip", .shape = {4}},
      {.name = "goal", .shape = {3}}};
  EXPECT_EQ(model.inputs, expected);
  EXPECT_EQ(model.output, (OnnxPort{.name = "action", .shape = {3}}));
}

TEST(OnnxPolicy, AChangedWeightIsSeen) {
  const policy::CheckpointPolicy policy = RandomPolicy({""});
  OnnxModel model = PolicyToOnnx(policy);
  model.constants.at("actor.mlp.layer1.weight").values[5] += 0.05f;
  const ObservationSet observations =
      RandomObservations(policy.description.spec, {}, 40, /*seed=*/3);
  EXPECT_GT(Compare(OwnActions(policy, observations),
                    OnnxActions(model, policy.description.spec, observations), 40)
                .largest_difference,
            1e-4);
}

TEST(OnnxPolicy, WhatDoesNotFitIsRefused) {
  policy::CheckpointPolicy policy = RandomPolicy({""});
  policy.tensors.erase("actor.mlp.layer0.bias");
  EXPECT_THAT(ErrorMessage([&] { PolicyToOnnx(policy); }),
              HasSubstr("policy.safetensors: tensor actor.mlp.layer0.bias is missing"));
  policy = RandomPolicy({""});
  policy.description.spec.blocks[0].name = "action";
  EXPECT_THAT(UsageMessage([&] { PolicyToOnnx(policy); }), HasSubstr("a block called 'action'"));
}

TEST(PolicyActions, WhatIsNoNumberDiffers) {
  EXPECT_EQ(Compare({0, NAN, 1}, {0, 0, 1}, 1).largest_difference, INFINITY);
  const Agreement agreement = Compare({0.25f, -0.5f}, {0.25f, -1}, 1);
  EXPECT_EQ(agreement.largest_difference, 0.5f);
  EXPECT_EQ(agreement.least, -0.5f);
  EXPECT_EQ(agreement.most, 0.25f);
}

}  // namespace
}  // namespace shoal::launch
