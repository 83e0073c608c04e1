// SPDX-License-Identifier: Apache-2.0
// The tiled gradient of a convolution's weights, run on the host, beside the plain one.
#include "learner/device/card/weight_kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "learner/device/card/forward_kernels.h"
#include "learner/device/card/plain_convolutions.h"
#include "learner/device/kernels/host_block.h"

namespace shoal::learner::kernels {
namespace {

constexpr float kUnwritten = std::numeric_limits<float>::quiet_NaN();

// Memory that is aligned to 16 bytes.
struct Halves {
  std::vector<Eight> eights;
  uint16_t* data() { return eights.data()->numbers; }
};

Halves NoiseInHalves(int64_t size, uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  Halves values{std::vector<Eight>(size_t(CeilDivide(size, 8)))};
  for (int64_t i = 0; i < size; ++i) values.data()[i] = ToBf16(normal(random));
  return values;
}

MapShape Shape(int32_t batch, int32_t size, int32_t channels, int32_t filters, int32_t kernel,
               int32_t stride, int32_t padding) {
  const int32_t output = (size + 2 * padding - kernel) / stride + 1;
  return {.batch = batch,
          .height = size,
          .width = size,
          .channels = channels,
          .filters = filters,
          .kernel = kernel,
          .stride = stride,
          .padding = padding,
          .output_height = output,
          .output_width = output};
}

// Weight and bias gradients.
struct Gradients {
  explicit Gradients(const MapShape& shape)
      : weights(size_t(shape.weights()), kUnwritten), biases(size_t(shape.filters), kUnwritten) {}
  std::vector<float> weights, biases;
};

void RunByTiles(const MapShape& shape, Halves x, Halves dy, bool bias, HostOrder order,
                Gradients* gradients) {
  ConvolveWeightsByTiles tiles{.strips = ConvolveWeightsByTiles::StripsOf(shape),
                               .x = x.data(),
                               .dy = dy.data(),
                               .weight_gradient = gradients->weights.data(),
                               .bias_gradient = bias ? gradients->biases.data() : nullptr,
                               .partials = nullptr};
  std::vector<float> partials(size_t(tiles.PartialsSize()), kUnwritten);
  tiles.partials = partials.data();
  RunOnHost(tiles, order);
  if (tiles.parts() == 1) return;
  RunOnHost(AddWeightParts{.partials = partials.data(),
                           .parts = tiles.parts(),
                           .weights = shape.weights(),
                           .biases = shape.filters,
                           .weight_gradient = tiles.weight_gradient,
                           .bias_gradient = tiles.bias_gradient},
            order);
}

class WeightKernels : public ::testing::TestWithParam<MapShape> {};

TEST_P(WeightKernels, TilesEqualThePlainGradient) {
  const MapShape& shape = GetParam();
  Halves x = NoiseInHalves(shape.inputs(), 1), dy = NoiseInHalves(shape.outputs(), 2);
  Gradients expected(shape), forward(shape), backward(shape);
  RunOnHost(ConvolveWeights{.shape = shape,
                            .x = {.f32 = nullptr, .bf16 = x.data()},
                            .dy = {.f32 = nullptr, .bf16 = dy.data()},
                            .weight_gradient = expected.weights.data(),
                            .bias_gradient = expected.biases.data()},
            HostOrder::kForward);
  RunByTiles(shape, x, dy, /*bias=*/true, HostOrder::kForward, &forward);
  RunByTiles(shape, x, dy, /*bias=*/true, HostOrder::kBackward, &backward);
  EXPECT_EQ(forward.weights, backward.weights) << "the order of blocks and warps matters";
  EXPECT_EQ(forward.biases, backward.biases) << "the order of blocks and warps matters";
  for (size_t i = 0; i < expected.weights.size(); ++i) {
    ASSERT_NEAR(forward.weights[i], expected.weights[i], 1e-3) << "weight " << i;
  }
  for (size_t i = 0; i < expected.biases.size(); ++i) {
    ASSERT_NEAR(forward.biases[i], expected.biases[i], 1e-3) << "bias " << i;
  }
}

TEST_P(WeightKernels, TheBiasCanBeLeftOut) {
  const MapShape& shape = GetParam();
  const Halves x = NoiseInHalves(shape.inputs(), 3), dy = NoiseInHalves(shape.outputs(), 4);
  Gradients both(shape), weights(shape);
  RunByTiles(shape, x, dy, /*bias=*/true, HostOrder::kForward, &both);
  RunByTiles(shape, x, dy, /*bias=*/false, HostOrder::kForward, &weights);
  EXPECT_EQ(weights.weights, both.weights);
}

TEST_P(WeightKernels, TheConvolutionByTilesEqualsThePlainOne) {
  const MapShape& shape = GetParam();
  ASSERT_GT(ConvolveForwardByTiles::StripsOf(shape).rows, 0);
  Halves x = NoiseInHalves(shape.inputs(), 5), weight = NoiseInHalves(shape.weights(), 6);
  std::vector<float> bias(size_t(shape.filters), 0.0F);
  for (size_t n = 0; n < bias.size(); ++n) bias[n] = float(n % 7) - 3;
  const auto run = [&](bool with_bias, HostOrder order) {
    Halves y = NoiseInHalves(shape.outputs(), 7);
    RunOnHost(ConvolveForwardByTiles{.strips = ConvolveForwardByTiles::StripsOf(shape),
                                     .x = x.data(),
                                     .weight = weight.data(),
                                     .bias = with_bias ? bias.data() : nullptr,
                                     .relu = with_bias ? 1 : 0,
                                     .y = y.data()},
              order);
    return y;
  };
  for (const bool with_bias : {true, false}) {
    Halves forward = run(with_bias, HostOrder::kForward);
    Halves backward = run(with_bias, HostOrder::kBackward);
    std::vector<float> expected(size_t(shape.outputs()), kUnwritten);
    RunOnHost(ConvolveForward{.shape = shape,
                              .x = {.f32 = nullptr, .bf16 = x.data()},
                              .weight = {.f32 = nullptr, .bf16 = weight.data()},
                              .bias = with_bias ? bias.data() : nullptr,
                              .relu = with_bias ? 1 : 0,
                              .y = {.f32 = expected.data()}},
              HostOrder::kForward);
    for (int64_t i = 0; i < shape.outputs(); ++i) {
      ASSERT_EQ(forward.data()[i], backward.data()[i]) << i;
      const float value = expected[size_t(i)];
      ASSERT_NEAR(FromBf16(forward.data()[i]), value, 1e-3 + 0.005 * std::abs(value)) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, WeightKernels,
    ::testing::Values(Shape(2, 9, 8, 16, 3, 2, 0),     // groups that are not full, several parts
                      Shape(3, 7, 32, 32, 3, 1, 1),    // full groups, a padding
                      Shape(2, 5, 40, 40, 1, 1, 0),    // two groups of filters and of channels
                      Shape(2, 12, 8, 8, 4, 2, 1),     // two groups of positions
                      Shape(1, 20, 8, 32, 8, 4, 0),    // eight groups of positions
                      Shape(2, 33, 8, 8, 3, 1, 0),     // strips, the last one with fewer rows
                      Shape(1, 4, 264, 136, 3, 1, 1),  // a single part
                      Shape(1, 3, 16, 24, 3, 1, 0)),   // one pixel
    [](const ::testing::TestParamInfo<MapShape>& named) {
      const MapShape& s = named.param;
      return std::to_string(s.channels) + "Channels" + std::to_string(s.filters) + "FiltersOf" +
             std::to_string(s.kernel) + "Stride" + std::to_string(s.stride);
    });

int PartsOf(const MapShape& shape) {
  return ConvolveWeightsByTiles{.strips = ConvolveWeightsByTiles::StripsOf(shape)}.parts();
}

TEST(WeightKernels, FewGroupsAreDividedIntoParts) {
  EXPECT_GT(PartsOf(Shape(128, 20, 32, 32, 3, 1, 0)), 180);
  EXPECT_EQ(PartsOf(Shape(1, 4, 264, 136, 3, 1, 1)), 1);
}

int RowsOf(const MapShape& shape) { return ConvolveWeightsByTiles::StripsOf(shape).rows; }

TEST(WeightKernels, AStripFitsInSharedMemory) {
  EXPECT_EQ(RowsOf(Shape(1, 20, 32, 32, 3, 1, 0)), 6);  // of 18
  EXPECT_EQ(RowsOf(Shape(1, 300, 8, 8, 3, 2, 0)), 1);   // 149 pixels
  EXPECT_EQ(RowsOf(Shape(1, 300, 8, 8, 3, 1, 0)), 0);   // 298 pixels
  EXPECT_EQ(RowsOf(Shape(1, 110, 32, 8, 3, 1, 0)), 0);  // 330 of x
}

}  // namespace
}  // namespace shoal::learner::kernels
