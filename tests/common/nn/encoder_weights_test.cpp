// SPDX-License-Identifier: Apache-2.0
#include "common/nn/encoder_weights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "common/base/files.h"
#include "common/nn/actor_critic_plan.h"
#include "common/nn/parameter_set.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::nn {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class EncoderWeightsTest : public testing::Test {
 protected:
  EncoderWeightsTest() {
    spec_.cameras = {"front"};
    spec_.channels = 1;
    spec_.height = spec_.width = 84;
    spec_.stack = 4;
    spec_.action_size = 2;
    network_.encoder = "alexnet";
    network_.initialisation = "pytorch";  // orthogonal weights take long
    network_.encoder_weights = (folder_.path() / "encoder.safetensors").string();
    ParameterSet set(PlanEncoder(network_, spec_).Parameters(), ParameterSet::Use::kInference);
    set.Initialise(5);
    set.Export(&ours_);
  }

  // Tensors with torchvision's names.
  TensorMap Bare() const {
    TensorMap bare;
    for (const auto& [name, tensor] : ours_) bare[name.substr(std::strlen("encoder."))] = tensor;
    return bare;
  }

  TensorMap Read(const TensorMap& file) const {
    WriteFileAtomically(network_.encoder_weights, WriteSafetensors(file, {}));
    return ReadEncoderWeights(network_, spec_);
  }
  std::string Refusal(const TensorMap& file) const {
    return UsageMessage([&] { Read(file); });
  }

  static NamedTensor Tensor(std::vector<int64_t> shape) {
    int64_t bytes = sizeof(float);
    for (const int64_t size : shape) bytes *= size;
    return {"F32", std::move(shape), std::vector<uint8_t>(size_t(bytes))};
  }

  void ExpectOurs(const TensorMap& read) const {
    ASSERT_EQ(read.size(), ours_.size());
    for (const auto& [name, tensor] : ours_) {
      ASSERT_TRUE(read.contains(name)) << name;
      EXPECT_EQ(read.at(name).data, tensor.data) << name;
    }
  }

  const TemporaryFolder folder_;
  ObservationSpec spec_;
  NetworkConfig network_;
  TensorMap ours_;
};

TEST_F(EncoderWeightsTest, APolicysFileStartsAnEncoderWhateverElseIsInIt) {
  TensorMap policy = ours_;
  policy["actor.trunk.bias"] = Tensor({50});
  ExpectOurs(Read(policy));
}

TEST_F(EncoderWeightsTest, TorchvisionsNamesAreTakenAndItsClassifierLeftAlone) {
  TensorMap theirs = Bare();
  theirs["classifier.1.weight"] = Tensor({4096, 3});
  theirs["fc.bias"] = Tensor({1000});
  theirs["bn1.num_batches_tracked"] = {"I64", {}, std::vector<uint8_t>(8)};
  ExpectOurs(Read(theirs));
}

TEST_F(EncoderWeightsTest, NoKeyGivesNothing) {
  NetworkConfig none = network_;
  none.encoder_weights.clear();
  EXPECT_TRUE(ReadEncoderWeights(none, spec_).empty());
}

TEST_F(EncoderWeightsTest, WhatDoesNotFitIsRefusedByName) {
  EXPECT_THAT(UsageMessage([&] { ReadEncoderWeights(network_, spec_); }),
              AllOf(HasSubstr("network.encoder_weights"), HasSubstr("encoder.safetensors")));

  TensorMap file = Bare();
  file.erase("features.8.bias");
  EXPECT_THAT(Refusal(file), AllOf(HasSubstr("network.encoder_weights"),
                                   HasSubstr("tensor features.8.bias is missing")));
  file = ours_;
  file.at("encoder.features.0.weight") = Tensor({64, 3, 11, 11});
  EXPECT_THAT(Refusal(file), HasSubstr("tensor encoder.features.0.weight has shape 64x3x11x11, "
                                       "expected 64x4x11x11"));
  file = ours_;
  file.at("encoder.features.3.bias") = {"U64", {192}, std::vector<uint8_t>(192 * 8)};
  EXPECT_THAT(Refusal(file), HasSubstr("tensor encoder.features.3.bias is U64, expected F32"));
  file = ours_;
  file["encoder.features.12.weight"] = Tensor({2, 2});
  EXPECT_THAT(Refusal(file), HasSubstr("tensor encoder.features.12.weight is none of "
                                       "network.encoder = alexnet"));
  file = Bare();
  file["layer1.2.conv1.weight"] = Tensor({2, 2});
  EXPECT_THAT(Refusal(file), HasSubstr("tensor layer1.2.conv1.weight is none of"));
  file = ours_;
  const float infinite = INFINITY;
  std::memcpy(file.at("encoder.features.3.bias").data.data(), &infinite, sizeof(infinite));
  EXPECT_THAT(Refusal(file), HasSubstr("tensor encoder.features.3.bias holds inf"));
}

TEST_F(EncoderWeightsTest, WithoutPixelsThereIsNoEncoderToStart) {
  Read(ours_);
  ObservationSpec state;
  state.blocks = {{"goal", 3}};
  EXPECT_THAT(UsageMessage([&] { ReadEncoderWeights(network_, state); }),
              HasSubstr("no encoder without pixels"));
}

}  // namespace
}  // namespace shoal::nn
