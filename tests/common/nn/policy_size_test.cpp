#include "common/nn/policy_size.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/nn/network_parameters.h"
#include "common/nn/safetensors.h"

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

std::string Refusal(const NetworkConfig& network) {
  try {
    CheckPolicySize(network, Pixels(), kMost);
  } catch (const Error& e) {
    EXPECT_EQ(e.exit_code(), 2);
    return e.what();
  }
  return "";
}

TEST(PolicySize, IsAtLeastThatOfTheFileAndNearIt) {
  const NetworkConfig network;
  TensorMap tensors;
  for (const auto& shapes :
       {EncoderParameters(network, Pixels()), ActorParameters(network, Pixels())}) {
    for (const ParameterShape& shape : shapes) {
      int64_t bytes = 4;
      for (const int64_t extent : shape.shape) bytes *= extent;
      tensors[shape.name] = {"F32", shape.shape, std::vector<uint8_t>(size_t(bytes))};
    }
  }
  const auto file = static_cast<int64_t>(WriteSafetensors(tensors, {{"format", "shoal"}}).size());
  EXPECT_GE(PolicyBytes(network, Pixels()), file);
  EXPECT_LE(PolicyBytes(network, Pixels()), file + 10'000);
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
