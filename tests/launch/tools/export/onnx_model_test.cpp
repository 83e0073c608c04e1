// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/onnx_model.h"

#include <gmock/gmock.h>

#include "common/base/error.h"

namespace shoal::launch {
namespace {

using testing::HasSubstr;

OnnxModel ModelWithConstant() {
  return {.inputs = {{.name = "pixels", .type = OnnxPort::Type::kU8, .shape = {3, 5, 7}},
                     {.name = "grip", .shape = {4}}},
          .output = {.name = "action", .shape = {2}},
          .nodes = {{.op = "Conv",
                     .inputs = {"pixels", "w"},
                     .output = "/Conv_0",
                     .attributes = {{"pads", std::vector<int64_t>{1, 1, 1, 1}},
                                    {"axis", int64_t{-1}},
                                    {"epsilon", 1e-5f}}},
                    {.op = "Tanh", .inputs = {"/Conv_0"}, .output = "action"}},
          .constants = {{"w", {{2, 1}, {0.5f, -3}}}, {"half", {{}, {0.5f}}}},
          .metadata = {{"task", "FetchReach"}}};
}

std::string TextRefusal(std::string_view bytes) {
  try {
    ReadOnnx(bytes, "policy.onnx");
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(OnnxModel, IsReadBackAsItWasWritten) {
  EXPECT_EQ(ReadOnnx(WriteOnnx(ModelWithConstant()), "test"), ModelWithConstant());
  EXPECT_EQ(WriteOnnx(ModelWithConstant()), WriteOnnx(ModelWithConstant()));
}

// Field numbers, held to the published format by its bytes: field << 3 | wire type.
TEST(OnnxModel, HasTheFormatsFieldNumbers) {
  const std::string bytes = WriteOnnx(
      {.output = {.name = "a", .shape = {2}},
       .nodes =
           {{.op = "Relu", .inputs = {"x"}, .output = "a", .attributes = {{"to", int64_t{1}}}}},
       .constants = {{"c", {{1}, {1.f}}}}});
  const auto expect = [&](std::string_view part, const char* what) {
    EXPECT_THAT(bytes, HasSubstr(std::string(part))) << what;
  };
  expect(std::string_view("\x08\x08\x12\x05shoal\x1a", 10), "ir_version 1, producer 2 and 3");
  expect(std::string_view("\x42\x02\x10\x11", 4), "opset_import 8 {version 2: 17}");
  expect(std::string_view("\x0a\x1a\x0a\x01x\x12\x01"
                          "a\x1a\x01"
                          "a\x22\x04Relu\x2a\x09\x0a\x02to\x18\x01"
                          "\xa0\x01\x02",
                          28),
         "node 1 {input 1, output 2, name 3, op_type 4, attribute 5 {name 1, i 3, type 20}}");
  expect(std::string_view("\x2a\x0e\x0a\x01\x01\x10\x01\x42\x01"
                          "cJ\x04\0\0\x80?",
                          16),
         "initializer 5 {dims 1, data_type 2, name 8, raw_data 9}");
  expect(std::string_view("\x62\x14\x0a\x01"
                          "a\x12\x0f\x0a\x0d\x08\x01\x12\x09\x0a\x03\x12\x01N\x0a\x02\x08\x02",
                          22),
         "output 12 {name 1, type 2 {tensor_type 1 {elem_type 1, shape 2 {dim 1}}}}");
}

TEST(OnnxModel, WhatIsNoneIsRefused) {
  EXPECT_THAT(TextRefusal("not a model"), HasSubstr("policy.onnx: not an ONNX file"));
  EXPECT_THAT(TextRefusal(""),
              HasSubstr("policy.onnx: the operator set: expected version 17 alone"));
  const std::string good = WriteOnnx(ModelWithConstant());
  EXPECT_THAT(TextRefusal(std::string_view(good).substr(0, good.size() - 1)),
              HasSubstr("policy.onnx"));
  OnnxModel short_constant = ModelWithConstant();
  short_constant.constants["w"].values.pop_back();
  EXPECT_THAT(TextRefusal(WriteOnnx(short_constant)),
              HasSubstr("policy.onnx: w: expected as many bytes as its shape"));
}

}  // namespace
}  // namespace shoal::launch
