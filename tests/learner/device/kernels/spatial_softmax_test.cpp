// SPDX-License-Identifier: Apache-2.0
#include "learner/device/kernels/spatial_softmax.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/learner/device/kernels/kernel_fixture.h"

namespace shoal::learner::kernels {
namespace {

// Odd sizes: two groups of channels, lanes without pixels, three channels of padding.
constexpr PointsShape kShape{
    .batch = 3, .height = 5, .width = 4, .channels = 37, .padded = 40, .sharpness = 7};
constexpr size_t kMap = size_t(kShape.map_size());
constexpr size_t kPoints = size_t(kShape.batch) * 2 * size_t(kShape.padded);

size_t MapAt(const PointsShape& shape, int row, int pixel, int channel) {
  return (size_t(row) * shape.pixels() + pixel) * shape.padded + channel;
}
size_t PointAt(const PointsShape& shape, int row, bool down, int channel) {
  return (size_t(row) * 2 + int(down)) * shape.padded + channel;
}

double Coordinate(int at, int side) { return side == 1 ? 0 : 2.0 * at / (side - 1) - 1; }

// Both coordinates of a channel's point, in double.
std::array<double, 2> PointOf(const PointsShape& shape, const std::vector<float>& x, int row,
                              int channel) {
  double largest = x[MapAt(shape, row, 0, channel)];
  for (int pixel = 1; pixel < shape.pixels(); ++pixel) {
    largest = std::max(largest, double(x[MapAt(shape, row, pixel, channel)]));
  }
  double total = 0, across = 0, down = 0;
  for (int pixel = 0; pixel < shape.pixels(); ++pixel) {
    const double value = x[MapAt(shape, row, pixel, channel)] - largest;
    const double p = std::exp(double(shape.sharpness) * value);
    total += p;
    across += p * Coordinate(pixel % shape.width, shape.width);
    down += p * Coordinate(pixel / shape.width, shape.height);
  }
  return {across / total, down / total};
}

class SpatialSoftmaxKernels : public KernelTest {
 protected:
  std::vector<float> x_ = Random(kMap, -0.5, 0.5);
  float* points_ = Out(kPoints);
  float* largest_ = Out(size_t(kShape.batch) * kShape.padded);
  float* total_ = Out(size_t(kShape.batch) * kShape.padded);
};

TEST_F(SpatialSoftmaxKernels, PointsAreMeansOfCoordinatesAndPaddingIsZero) {
  auto* rounded = Out<uint16_t>(kPoints);
  Run(SpatialSoftmaxForward{.shape = kShape,
                            .x = {In(x_), nullptr},
                            .points = {points_, rounded},
                            .largest = largest_,
                            .total = total_});
  for (int row = 0; row < kShape.batch; ++row) {
    for (int channel = 0; channel < kShape.padded; ++channel) {
      for (const bool down : {false, true}) {
        const size_t at = PointAt(kShape, row, down, channel);
        const bool padding = channel >= kShape.channels;
        const double expected = padding ? 0 : PointOf(kShape, x_, row, channel)[size_t(down)];
        ASSERT_NEAR(points_[at], expected, padding ? 0 : 2e-6) << at;
        ASSERT_EQ(rounded[at], ToBf16(points_[at])) << at;
      }
    }
  }
}

// exp of these values is more than f32 holds. All pixels are above each other.
TEST_F(SpatialSoftmaxKernels, LargeValuesInAColumnOfPixels) {
  constexpr PointsShape kColumn{
      .batch = 2, .height = 17, .width = 1, .channels = 8, .padded = 8, .sharpness = 7};
  const std::vector<float> x = Random(size_t(kColumn.map_size()), -100, 100);
  Run(SpatialSoftmaxForward{.shape = kColumn,
                            .x = {In(x), nullptr},
                            .points = {points_, nullptr},
                            .largest = largest_,
                            .total = total_});
  for (int row = 0; row < kColumn.batch; ++row) {
    for (int channel = 0; channel < kColumn.channels; ++channel) {
      ASSERT_EQ(points_[PointAt(kColumn, row, false, channel)], 0.f);
      ASSERT_NEAR(points_[PointAt(kColumn, row, true, channel)],
                  PointOf(kColumn, x, row, channel)[1], 1e-5);
    }
  }
}

TEST_F(SpatialSoftmaxKernels, GradientsAreThoseOfThePoints) {
  const std::vector<float> dpoints = Random(kPoints);
  float *x = In(x_), *dx = Out(kMap);
  Run(SpatialSoftmaxForward{.shape = kShape,
                            .x = {x, nullptr},
                            .points = {points_, nullptr},
                            .largest = largest_,
                            .total = total_});
  Run(SpatialSoftmaxBackward{.shape = kShape,
                             .x = {x, nullptr},
                             .points = points_,
                             .largest = largest_,
                             .total = total_,
                             .dpoints = {In(dpoints), nullptr},
                             .dx = {dx, nullptr}});
  const auto loss = [&](const std::vector<float>& map, int row, int channel) {
    const std::array<double, 2> point = PointOf(kShape, map, row, channel);
    return dpoints[PointAt(kShape, row, false, channel)] * point[0] +
           dpoints[PointAt(kShape, row, true, channel)] * point[1];
  };
  for (size_t i = 0; i < kMap; ++i) {
    const int channel = int(i % size_t(kShape.padded));
    const int row = int(i / size_t(kShape.padded) / size_t(kShape.pixels()));
    if (channel >= kShape.channels) {
      ASSERT_EQ(dx[i], 0.f) << i;
      continue;
    }
    std::vector<float> more = x_, less = x_;
    more[i] += 1.f / 256;
    less[i] -= 1.f / 256;
    const double difference = double(more[i]) - less[i];
    ASSERT_NEAR(dx[i], (loss(more, row, channel) - loss(less, row, channel)) / difference, 2e-3)
        << i;
  }
}

TEST_F(SpatialSoftmaxKernels, Bf16IsReadAndWritten) {
  std::vector<uint16_t> narrow, narrow_points;
  for (const float value : x_) narrow.push_back(ToBf16(value));
  for (const float value : Random(kPoints)) narrow_points.push_back(ToBf16(value));
  const auto backward = [&](const Source& x, const Source& dpoints, const Target& dx) {
    Run(SpatialSoftmaxForward{.shape = kShape,
                              .x = x,
                              .points = {points_, nullptr},
                              .largest = largest_,
                              .total = total_});
    Run(SpatialSoftmaxBackward{.shape = kShape,
                               .x = x,
                               .points = points_,
                               .largest = largest_,
                               .total = total_,
                               .dpoints = dpoints,
                               .dx = dx});
  };
  auto* rounded = Out<uint16_t>(kMap);
  backward({nullptr, In(narrow)}, {nullptr, In(narrow_points)}, {nullptr, rounded});
  float* wide = Out(kMap);
  backward({In(FromBf16s(narrow.data(), kMap)), nullptr},
           {In(FromBf16s(narrow_points.data(), kPoints)), nullptr}, {wide, nullptr});
  for (size_t i = 0; i < kMap; ++i) ASSERT_EQ(rounded[i], ToBf16(wide[i])) << i;
}

}  // namespace
}  // namespace shoal::learner::kernels
