// SPDX-License-Identifier: Apache-2.0
#include "common/nn/network_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/nn/actor_critic_plan.h"
#include "common/nn/safetensors.h"
#include "tests/support/error_message.h"

namespace shoal::nn {
namespace {

constexpr int64_t kMost = 63'000'000;

ObservationSpec Pixels() {
  ObservationSpec spec;
  spec.cameras = {"front"};
  spec.channels = 3;
  spec.height = spec.width = 84;
  spec.stack = 3;
  spec.action_size = 4;
  return spec;
}

std::string Refusal(const NetworkConfig& network, int batch = 128, int64_t most = kMost) {
  return UsageMessage([&] { CheckNetwork(network, Pixels(), batch, most); });
}

TEST(PolicySize, IsAtLeastThatOfTheFileAndNearIt) {
  const NetworkConfig network;
  TensorMap tensors;
  for (const ParameterSpec& parameter : PolicyParameters(network, Pixels())) {
    int64_t bytes = 4;
    for (const int64_t extent : parameter.shape) bytes *= extent;
    tensors[parameter.name] = {"F32", parameter.shape,
                               std::vector<uint8_t>(static_cast<size_t>(bytes))};
  }
  const auto file = static_cast<int64_t>(WriteSafetensors(tensors, {{"format", "shoal"}}).size());
  EXPECT_GE(PolicyBytes(network, Pixels()), file);
  EXPECT_LE(PolicyBytes(network, Pixels()), file + 10'000);
}

TEST(NetworkCheck, ArraysThatAnIntCannotCountAreRefusedNamingKeyLayerAndBatch) {
  NetworkConfig network;
  network.hidden = {65'536};
  EXPECT_EQ(Refusal(network, 32'767), "");  // 32767 * 65536 < 2^31
  EXPECT_EQ(Refusal(network, 32'768),
            "network.hidden: the outputs of actor.mlp.layer0 are 65536 numbers for each of "
            "learner.batch = 32768, expected at most 2147483647 in all");
  network = {};
  network.pool = 1;
  network.filters = {4096, 4};
  network.strides = {1, 8};
  EXPECT_THAT(Refusal(network, 128), testing::StartsWith("network.filters: the outputs of"));
  EXPECT_EQ(Refusal(network, 64), "");
}

TEST(NetworkCheck, AnEncoderThatDoesNotFitIsRefused) {
  NetworkConfig network;
  network.encoder = "spatial_softmax";
  ObservationSpec odd = Pixels();
  odd.width = 63;
  EXPECT_THAT(UsageMessage([&] { CheckNetwork(network, odd, 1, kMost); }),
              testing::HasSubstr("even sides, not 84x63"));
}

TEST(NetworkCheck, StatisticsOfOneValueAreRefusedNamingBatchAndLayer) {
  NetworkConfig network;
  network.encoder = "resnet18";
  ObservationSpec small = Pixels();
  small.height = small.width = 32;  // 1x1 in the last group of layers
  EXPECT_EQ(UsageMessage([&] { CheckNetwork(network, small, 1, kMost); }),
            "learner.batch = 1: encoder.layer4.0.bn1 of network.encoder = resnet18 has 1x1 maps of "
            "these images, whose batch statistics take at least 2 of them");
  EXPECT_EQ(UsageMessage([&] { CheckNetwork(network, small, 2, kMost); }), "");
  EXPECT_EQ(Refusal(network, 1), "");  // 3x3 of 84x84 pixels
}

TEST(PolicySize, WhatNoMessageHoldsIsRefusedNamingTheKeyAndTheLimit) {
  EXPECT_EQ(Refusal({}), "");
  NetworkConfig network;
  network.hidden = {4096, 4096};
  EXPECT_THAT(Refusal(network), testing::HasSubstr("network.hidden: the policy's parameters take"));
  EXPECT_THAT(Refusal(network), testing::HasSubstr("at most 63.0 MB"));
  network = {};
  network.features = 65'536;
  EXPECT_THAT(Refusal(network), testing::StartsWith("network.features"));
  network = {};
  network.filters = {4096, 4096, 4};
  EXPECT_THAT(Refusal(network), testing::StartsWith("network.filters"));
}

}  // namespace
}  // namespace shoal::nn
