// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/export/onnx_operators.h"

#include <gmock/gmock.h>

#include <cmath>

#include "common/base/error.h"

namespace shoal::launch {
namespace {

using testing::ElementsAre;
using testing::FloatNear;
using testing::Pointwise;
using Ints = std::vector<int64_t>;
using Attributes = std::map<std::string, OnnxAttribute>;

OnnxTensor Apply(const std::string& op, const std::vector<OnnxTensor>& inputs,
                 Attributes attributes = {}) {
  std::vector<const OnnxTensor*> arguments;
  arguments.reserve(inputs.size());
  for (const OnnxTensor& input : inputs) arguments.push_back(&input);
  return FindOnnxOperator(op)(
      {.op = op, .inputs = {}, .output = "y", .attributes = std::move(attributes)}, arguments);
}

Attributes Window(int64_t kernel, int64_t stride, int64_t padding) {
  return {
      {"kernel_shape", Ints(2, kernel)}, {"strides", Ints(2, stride)}, {"pads", Ints(4, padding)}};
}

// 1, 2, 3, ...
OnnxTensor Counting(const Ints& shape) {
  OnnxTensor tensor{.shape = shape};
  for (size_t i = 0; i < Count(shape); ++i) tensor.values.push_back(float(i + 1));
  return tensor;
}

TEST(OnnxOperators, OneNumberAtATime) {
  const OnnxTensor x{{1, 4}, {-2, -0.5f, 0, 3}};
  EXPECT_EQ(Apply("Relu", {x}).values, (std::vector<float>{0, 0, 0, 3}));
  EXPECT_EQ(Apply("Clip", {x, {{}, {-1}}, {{}, {1}}}).values,
            (std::vector<float>{-1, -0.5f, 0, 1}));
  EXPECT_THAT(Apply("Tanh", {x}).values,
              Pointwise(FloatNear(1e-6f), {-0.9640276f, -0.4621172f, 0.f, 0.9950548f}));
  EXPECT_THAT(Apply("Elu", {x}).values,
              Pointwise(FloatNear(1e-6f), {-0.8646647f, -0.3934693f, 0.f, 3.f}));
  EXPECT_EQ(Apply("Cast", {x}, {{"to", int64_t{1}}}), x);
  EXPECT_TRUE(std::isnan(Apply("Relu", {{{1}, {NAN}}}).values[0]));
}

TEST(OnnxOperators, ASecondInputComesRoundAgain) {
  const OnnxTensor x = Counting({2, 2});
  EXPECT_EQ(Apply("Add", {x, {{2}, {10, 20}}}).values, (std::vector<float>{11, 22, 13, 24}));
  EXPECT_EQ(Apply("Sub", {x, {{}, {0.5f}}}).values, (std::vector<float>{0.5f, 1.5f, 2.5f, 3.5f}));
  EXPECT_EQ(Apply("Mul", {x, x}).values, (std::vector<float>{1, 4, 9, 16}));
  EXPECT_THROW(Apply("Add", {x, {{3}, {1, 2, 3}}}), Error);
  EXPECT_THROW(Apply("Add", {{{2}, {1, 2}}, x}), Error);
}

TEST(OnnxOperators, Shapes) {
  EXPECT_EQ(Apply("Flatten", {Counting({2, 1, 2, 2})}, {{"axis", int64_t{1}}}), Counting({2, 4}));
  const OnnxTensor joined =
      Apply("Concat", {Counting({2, 1}), {{2, 2}, {7, 8, 9, 10}}}, {{"axis", int64_t{1}}});
  EXPECT_EQ(joined, (OnnxTensor{{2, 3}, {1, 7, 8, 2, 9, 10}}));
}

TEST(OnnxOperators, Products) {
  // Rows of W are outputs: 1*1 + 2*2 + 10 and 1*3 + 2*4 + 20.
  EXPECT_EQ(Apply("Gemm", {Counting({1, 2}), Counting({2, 2}), {{2}, {10, 20}}},
                  {{"transB", int64_t{1}}}),
            (OnnxTensor{{1, 2}, {15, 31}}));
  const OnnxTensor matrix = Counting({2, 2});  // [1 2; 3 4]
  const OnnxTensor maps = Counting({1, 2, 1, 2});
  EXPECT_EQ(Apply("MatMul", {maps, matrix}), (OnnxTensor{{1, 2, 1, 2}, {7, 10, 15, 22}}));
  EXPECT_EQ(Apply("MatMul", {matrix, Counting({2, 2, 1})}),
            (OnnxTensor{{2, 2, 1}, {5, 11, 11, 25}}));
}

TEST(OnnxOperators, Pools) {
  const OnnxTensor map = Counting({1, 1, 3, 3});  // [1 2 3; 4 5 6; 7 8 9]
  EXPECT_EQ(Apply("AveragePool", {map}, {{"kernel_shape", Ints{2, 2}}, {"strides", Ints{1, 1}}}),
            (OnnxTensor{{1, 1, 2, 2}, {3, 4, 6, 7}}));
  // Rows and columns that do not fill a window are left out.
  EXPECT_EQ(Apply("AveragePool", {map}, {{"kernel_shape", Ints{2, 2}}, {"strides", Ints{2, 2}}}),
            (OnnxTensor{{1, 1, 1, 1}, {3}}));
  EXPECT_EQ(Apply("MaxPool", {map}, Window(3, 2, 1)), (OnnxTensor{{1, 1, 2, 2}, {5, 6, 8, 9}}));
  // Padding is lower than any number.
  OnnxTensor negative = map;
  for (float& value : negative.values) value -= 20;
  EXPECT_EQ(Apply("MaxPool", {negative}, Window(3, 2, 1)).values,
            (std::vector<float>{-15, -14, -12, -11}));
}

TEST(OnnxOperators, Convolutions) {
  // Two channels of a 2x3 map, one filter: the sum of the first channel's window and twice the
  // second one's upper left.
  const OnnxTensor map = Counting({1, 2, 2, 3});  // [1 2 3; 4 5 6], [7 8 9; 10 11 12]
  const OnnxTensor filter{{1, 2, 2, 2}, {1, 1, 1, 1, 2, 0, 0, 0}};
  EXPECT_EQ(Apply("Conv", {map, filter, {{1}, {100}}}, Window(2, 1, 0)),
            (OnnxTensor{{1, 1, 1, 2}, {126, 132}}));
  // Padding is 0: windows begin at rows and columns -1 and 1.
  EXPECT_EQ(Apply("Conv", {map, filter}, Window(2, 2, 1)),
            (OnnxTensor{{1, 1, 2, 2}, {1, 5, 4, 11 + 2 * 11}}));
  // Images and filters keep apart.
  const OnnxTensor images = Counting({2, 1, 1, 1}), filters{{2, 1, 1, 1}, {1, 10}};
  EXPECT_EQ(Apply("Conv", {images, filters}, Window(1, 1, 0)).values,
            (std::vector<float>{1, 10, 2, 20}));
}

TEST(OnnxOperators, Normalisations) {
  // Channel 0: (x - 1) / sqrt(4) * 2 + 5; channel 1: (x - 0) / 1 * 1 + 0. Variances less epsilon.
  const float epsilon = 0.5f;
  const OnnxTensor normal = Apply("BatchNormalization",
                                  {{{2, 2, 1, 1}, {3, 7, 1, -2}},
                                   {{2}, {2, 1}},
                                   {{2}, {5, 0}},
                                   {{2}, {1, 0}},
                                   {{2}, {3.5f, 0.5f}}},
                                  {{"epsilon", epsilon}});
  EXPECT_THAT(normal.values, ElementsAre(7, 7, 5, -2));
  // Mean 2, variance 1.5 - 0.5 + epsilon: rows [0 4], deviation sqrt(4 + 0.5)... of 0 and 4: 2.
  const float scale = 2 / std::sqrt(4 + epsilon);
  EXPECT_THAT(Apply("LayerNormalization", {{{2, 2}, {0, 4, 5, 5}}, {{2}, {1, 3}}, {{2}, {0, 10}}},
                    {{"axis", int64_t{-1}}, {"epsilon", epsilon}})
                  .values,
              Pointwise(FloatNear(1e-6f), {-scale, 3 * scale + 10, 0.f, 10.f}));
}

TEST(OnnxOperators, WhatIsNotKnownIsNotThere) { EXPECT_EQ(FindOnnxOperator("Softmax"), nullptr); }

TEST(OnnxOperators, WhatDoesNotFitIsRefused) {
  const OnnxTensor map = Counting({1, 1, 3, 3});
  EXPECT_THROW(Apply("Conv", {map, Counting({1, 2, 3, 3})}, Window(3, 1, 0)), Error);
  EXPECT_THROW(Apply("Conv", {map, Counting({1, 1, 3, 3})}), Error);
  EXPECT_THROW(Apply("MaxPool", {map}, Window(5, 1, 0)), Error);
  EXPECT_THROW(
      Apply("Gemm", {Counting({1, 3}), Counting({2, 2}), Counting({2})}, {{"transB", int64_t{1}}}),
      Error);
  EXPECT_THROW(Apply("MatMul", {map, Counting({2, 2})}), Error);
}

}  // namespace
}  // namespace shoal::launch
