// SPDX-License-Identifier: Apache-2.0
#include "common/nn/safetensors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "common/base/error.h"
#include "common/base/random.h"
#include "common/nn/bf16.h"

namespace shoal::nn {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

NamedTensor F32(const std::vector<int64_t>& shape, const std::vector<float>& values) {
  NamedTensor tensor{"F32", shape, std::vector<uint8_t>(values.size() * sizeof(float))};
  if (!values.empty()) std::memcpy(tensor.data.data(), values.data(), tensor.data.size());
  return tensor;
}

// A file from a header text and `data_bytes` zeros.
std::string File(const std::string& header, size_t data_bytes) {
  const uint64_t length = header.size();
  std::string file(sizeof(length), '\0');
  std::memcpy(file.data(), &length, sizeof(length));
  return file + header + std::string(data_bytes, '\0');
}

void ExpectRefused(const std::string& file, const std::string& part) {
  EXPECT_THAT([&] { ReadSafetensors(file, "some file"); },
              ThrowsMessage<Error>(AllOf(HasSubstr("some file"), HasSubstr(part))))
      << file.substr(8, 200);
}

TensorMap Sample() {
  TensorMap tensors;
  tensors["a"] = F32({2, 3}, {1, 2, 3, 4, 5, -6.5f});
  tensors["empty"] = F32({0, 4}, {});
  tensors["scalar"] = F32({}, {7});
  tensors["n"] = {"U64", {1}, {1, 2, 3, 4, 5, 6, 7, 8}};
  tensors["half"] = {"BF16", {3}, {0x80, 0x3f, 0x00, 0xc0, 0x01, 0x00}};
  return tensors;
}

TEST(Safetensors, RoundTripKeepsEveryTensor) {
  const TensorMap tensors = Sample();
  const TensorMap read = ReadSafetensors(WriteSafetensors(tensors, {{"format", "pt"}}), "test");
  ASSERT_EQ(read.size(), tensors.size());
  for (const auto& [name, tensor] : tensors) {
    EXPECT_EQ(read.at(name).dtype, tensor.dtype) << name;
    EXPECT_EQ(read.at(name).shape, tensor.shape) << name;
    EXPECT_EQ(read.at(name).data, tensor.data) << name;
  }
}

TEST(Safetensors, ViewsPointIntoTheFile) {
  const TensorMap tensors = Sample();
  const std::string file = WriteSafetensors(tensors, {{"format", "pt"}});
  const TensorViews views = ReadSafetensorsViews(file, "test");
  ASSERT_EQ(views.all().size(), tensors.size());
  for (const auto& [name, tensor] : tensors) {
    const TensorView* view = views.Find(name);
    ASSERT_NE(view, nullptr) << name;
    EXPECT_EQ(view->dtype, tensor.dtype) << name;
    EXPECT_EQ(view->shape, tensor.shape) << name;
    EXPECT_EQ(std::vector<uint8_t>(view->data.begin(), view->data.end()), tensor.data) << name;
    const auto* begin = reinterpret_cast<const uint8_t*>(file.data());
    EXPECT_TRUE(view->data.data() >= begin && view->data.data() <= begin + file.size()) << name;
  }
  EXPECT_EQ(views.Find("b"), nullptr);
}

TEST(Safetensors, ViewsOfAMapAreItsBytes) {
  const TensorMap tensors = Sample();
  const TensorViews views = tensors;
  EXPECT_EQ(views.all().size(), tensors.size());
  EXPECT_EQ(views.Find("a")->data.data(), tensors.at("a").data.data());
  EXPECT_EQ(views.Find("a")->shape, tensors.at("a").shape);
}

TEST(Safetensors, BytesAreThoseOfTheFormat) {
  TensorMap tensors;
  tensors["w"] = F32({1, 2}, {1.f, -2.f});
  const std::string header =
      R"({"__metadata__":{"k":"v"},"w":{"data_offsets":[0,8],"dtype":"F32","shape":[1,2]}})";
  const std::string padded = header + std::string((8 - header.size() % 8) % 8, ' ');
  std::string expected = File(padded, 8);
  const float values[2] = {1.f, -2.f};
  std::memcpy(expected.data() + 8 + padded.size(), values, sizeof(values));
  EXPECT_EQ(WriteSafetensors(tensors, {{"k", "v"}}), expected);
}

TEST(Safetensors, EveryTruncationIsRefused) {
  const std::string file = WriteSafetensors(Sample(), {});
  for (size_t size = 0; size < file.size(); ++size) {
    EXPECT_THROW(ReadSafetensors(std::string_view(file).substr(0, size), "cut"), Error) << size;
  }
  EXPECT_THROW(ReadSafetensors(file + "x", "long"), Error);
}

// A flipped bit in the header may change a name or the padding, which a reader cannot detect. The
// reader must never crash, and the result must be consistent.
TEST(Safetensors, AFlippedHeaderBitIsRefusedOrGivesAConsistentMap) {
  const std::string file = WriteSafetensors(Sample(), {{"k", "v"}});
  uint64_t length = 0;
  std::memcpy(&length, file.data(), sizeof(length));
  int refused = 0, flips = 0;
  for (size_t bit = 0; bit < (8 + length) * 8; ++bit, ++flips) {
    std::string flipped = file;
    flipped[bit / 8] = char(flipped[bit / 8] ^ (1 << (bit % 8)));
    try {
      for (const auto& [name, tensor] : ReadSafetensors(flipped, "flipped")) {
        uint64_t bytes = tensor.dtype == "U64" ? 8 : tensor.dtype == "F32" ? 4 : 2;
        for (const int64_t size : tensor.shape) bytes *= uint64_t(size);
        ASSERT_EQ(tensor.data.size(), bytes) << name;
      }
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, flips / 2);
}

TEST(Safetensors, RandomBytesAreRefused) {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    std::string noise(random.Below(200), '\0');
    for (char& byte : noise) byte = char(random.Next());
    // Half of them with a header length that fits, so that the JSON parser sees noise too.
    if (noise.size() >= 8 && i % 2 == 0) {
      const uint64_t length = noise.size() - 8;
      std::memcpy(noise.data(), &length, sizeof(length));
    }
    EXPECT_THROW(ReadSafetensors(noise, "noise"), Error);
  }
}

TEST(Safetensors, HugeHeaderLengthIsRefusedWithoutReadingIt) {
  std::string file(64, '\0');
  for (const uint64_t length : {uint64_t(57), uint64_t(100'000'001), ~uint64_t(0)}) {
    std::memcpy(file.data(), &length, sizeof(length));
    ExpectRefused(file, "header");
  }
}

TEST(Safetensors, MalformedEntriesAreRefusedByName) {
  ExpectRefused(File("[]", 0), "JSON object");
  ExpectRefused(File(R"({"w":3})", 0), "w");
  ExpectRefused(File(R"({"w":{"dtype":"F32","shape":[1]}})", 4), "data_offsets");
  ExpectRefused(File(R"({"w":{"dtype":"F64","shape":[1],"data_offsets":[0,8]}})", 8), "dtype");
  ExpectRefused(File(R"({"w":{"dtype":"F32","shape":1,"data_offsets":[0,4]}})", 4), "shape");
  ExpectRefused(File(R"({"w":{"dtype":"F32","shape":[-1],"data_offsets":[0,4]}})", 4), "shape");
  ExpectRefused(File(R"({"w":{"dtype":"F32","shape":[1.5],"data_offsets":[0,4]}})", 4), "shape");
  ExpectRefused(File(R"({"w":{"dtype":"F32","shape":[2],"data_offsets":[0,4]}})", 4), "fit");
  ExpectRefused(File(R"({"w":{"dtype":"F32","shape":[1],"data_offsets":[4,0]}})", 4), "fit");
  ExpectRefused(File(R"({"w":{"dtype":"F32","shape":[1],"data_offsets":[0,4,8]}})", 4), "offsets");
  ExpectRefused(File(R"({"w":{"dtype":"F32","shape":[1],"data_offsets":[-4,0]}})", 4), "offsets");
  ExpectRefused(File(R"({"__metadata__":{"k":1}})", 0), "__metadata__");
}

TEST(Safetensors, SizesWhoseProductOverflowsAreRefused) {
  ExpectRefused(
      File(R"({"w":{"dtype":"F32","shape":[4294967296,4294967296],"data_offsets":[0,0]}})", 0),
      "too large");
  ExpectRefused(
      File(R"({"w":{"dtype":"F32","shape":[9223372036854775807],"data_offsets":[0,4]}})", 4),
      "too large");
}

TEST(Safetensors, OverlapsHolesAndStrayBytesAreRefused) {
  const std::string a = R"("a":{"dtype":"F32","shape":[2],"data_offsets":[0,8]})";
  const auto with_b = [&](const char* offsets) {
    return "{" + a + R"(,"b":{"dtype":"F32","shape":[1],"data_offsets":)" + offsets + "}}";
  };
  EXPECT_EQ(ReadSafetensors(File(with_b("[8,12]"), 12), "good").size(), 2u);
  ExpectRefused(File(with_b("[4,8]"), 8), "begins at byte 4");
  ExpectRefused(File(with_b("[12,16]"), 16), "begins at byte 12");
  ExpectRefused(File(with_b("[8,12]"), 16), "16 bytes of data");
  ExpectRefused(File(with_b("[8,12]"), 8), "8 bytes of data");
}

TEST(Safetensors, ANameGivenTwiceIsRefused) {
  const std::string entry = R"("w":{"dtype":"F32","shape":[1],"data_offsets":[0,4]})";
  ExpectRefused(File("{" + entry + "," + entry + "}", 4), "twice");
}

TEST(Safetensors, Bf16CopyHoldsTheRoundedValuesAndLeavesOtherTypesAlone) {
  const TensorMap whole = Sample(), half = ToBf16(whole);
  std::vector<uint8_t> upper;  // these values are exact in bf16
  for (size_t i = 0; i < whole.at("a").data.size(); i += sizeof(float)) {
    const uint8_t* value = &whole.at("a").data[i];
    upper.insert(upper.end(), {value[2], value[3]});
  }
  EXPECT_EQ(half.at("a").dtype, "BF16");
  EXPECT_EQ(half.at("a").data, upper);
  for (const char* name : {"n", "half"}) {
    EXPECT_EQ(half.at(name).dtype, whole.at(name).dtype);
    EXPECT_EQ(half.at(name).data, whole.at(name).data);
  }
}

// Many more values than are rounded at once.
TEST(Safetensors, Bf16CopyOfALargeTensorIsRoundedThroughout) {
  std::vector<float> values(10'001);
  for (size_t i = 0; i < values.size(); ++i) values[i] = 0.1f * float(i);
  const TensorMap half = ToBf16({{"w", F32({int64_t(values.size())}, values)}});
  ASSERT_EQ(half.at("w").data.size(), 2 * values.size());
  std::vector<uint16_t> expected(values.size()), rounded(values.size());
  FloatsToBf16(values.data(), int64_t(values.size()), expected.data());
  std::memcpy(rounded.data(), half.at("w").data.data(), half.at("w").data.size());
  EXPECT_EQ(rounded, expected);
}

TEST(Safetensors, RunningStatisticsAreNotRounded) {
  const TensorMap tensors{{"bn1.running_mean", Sample().at("a")},
                          {"bn1.running_var", Sample().at("a")},
                          {"bn1.weight", Sample().at("a")}};
  const TensorMap half = ToBf16(tensors);
  EXPECT_EQ(half.at("bn1.running_mean").dtype, "F32");
  EXPECT_EQ(half.at("bn1.running_var").dtype, "F32");
  EXPECT_EQ(half.at("bn1.weight").dtype, "BF16");
}

}  // namespace
}  // namespace shoal::nn
