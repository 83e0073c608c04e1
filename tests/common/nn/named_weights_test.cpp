// SPDX-License-Identifier: Apache-2.0
#include "common/nn/named_weights.h"

#include <gmock/gmock.h>

#include <numeric>

#include "common/base/files.h"
#include "tests/support/error_message.h"
#include "tests/support/temporary_folder.h"

namespace shoal::nn {
namespace {

using testing::HasSubstr;

class NamedWeightsTest : public testing::Test {
 protected:
  NamedWeightsTest() {
    const auto tensor = [](std::vector<int64_t> shape, uint8_t first) {
      std::vector<uint8_t> data(size_t(shape[0] * (shape.size() > 1 ? shape[1] : 1)) * 4);
      std::iota(data.begin(), data.end(), first);
      return NamedTensor{"F32", std::move(shape), std::move(data)};
    };
    theirs_ = {{"mu.weight", tensor({2, 3}, 0)},
               {"log_std.weight", tensor({1, 3}, 50)},
               {"bias", tensor({3}, 100)}};
    WriteFileAtomically(file_, WriteSafetensors(theirs_, {}));
  }

  TensorMap ReadWith(const std::string& map) const {
    WriteFileAtomically(map_, map);
    return ReadNamedWeights(file_, map_);
  }
  std::string Refusal(const std::string& map) const {
    return UsageMessage([&] { ReadWith(map); });
  }

  const TemporaryFolder folder_;
  const std::string file_ = folder_.path() / "theirs.safetensors",
                    map_ = folder_.path() / "map.json";
  TensorMap theirs_;
};

TEST_F(NamedWeightsTest, WithoutAMapNamesStay) {
  const TensorMap read = ReadNamedWeights(file_, "");
  EXPECT_EQ(read.size(), 3u);
  EXPECT_EQ(read.at("bias").data, theirs_.at("bias").data);
}

TEST_F(NamedWeightsTest, AMapNamesAndPutsTogether) {
  const TensorMap read =
      ReadWith(R"({"actor.b": "bias", "actor.w": ["mu.weight", "log_std.weight"]})");
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read.at("actor.b").data, theirs_.at("bias").data);
  EXPECT_EQ(read.at("actor.w").shape, (std::vector<int64_t>{3, 3}));
  EXPECT_EQ(read.at("actor.w").data[0], 0);
  EXPECT_EQ(read.at("actor.w").data[2 * 3 * 4], 50);
}

TEST_F(NamedWeightsTest, WhatDoesNotFitIsRefusedByName) {
  EXPECT_THAT(Refusal(R"({"a": "absent"})"),
              HasSubstr("theirs.safetensors: tensor absent is missing"));
  EXPECT_THAT(Refusal(R"({"a": ["mu.weight", "bias"]})"),
              HasSubstr("the tensors of a do not go together"));
  EXPECT_THAT(Refusal(R"({"a": 3})"), HasSubstr("map.json: a: expected a tensor's name"));
  EXPECT_THAT(Refusal(R"({"a": []})"), HasSubstr("map.json: a: expected a tensor's name"));
  EXPECT_THAT(Refusal(R"(["a"])"), HasSubstr("map.json: expected a JSON object"));
  WriteFileAtomically(file_, "torch");
  EXPECT_THAT(UsageMessage([&] { ReadNamedWeights(file_, ""); }), HasSubstr("theirs.safetensors"));
}

}  // namespace
}  // namespace shoal::nn
