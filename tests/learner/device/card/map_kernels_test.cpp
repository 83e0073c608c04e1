// SPDX-License-Identifier: Apache-2.0
// The kernels for convolutions on a GPU, run on the host.
#include "learner/device/card/map_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "learner/device/card/plain_convolutions.h"
#include "learner/device/kernels/host_block.h"

namespace shoal::learner::kernels {
namespace {

constexpr float kPoison = std::numeric_limits<float>::quiet_NaN();

std::vector<float> Noise(int64_t size, uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  std::vector<float> values(size_t(size), 0.0F);
  for (float& value : values) value = normal(random);
  return values;
}

// Odd sizes, a stride, a padding.
std::vector<MapShape> Shapes() {
  std::vector<MapShape> shapes;
  for (const int stride : {1, 2, 3}) {
    for (const int padding : {0, 1}) {
      MapShape s{.batch = 3,
                 .height = 9,
                 .width = 7,
                 .channels = 5,
                 .filters = 4,
                 .kernel = 3,
                 .stride = stride,
                 .padding = padding,
                 .output_height = 0,
                 .output_width = 0};
      s.output_height = (s.height + 2 * padding - s.kernel) / stride + 1;
      s.output_width = (s.width + 2 * padding - s.kernel) / stride + 1;
      shapes.push_back(s);
    }
  }
  return shapes;
}

template <class Kernel>
void RunBothOrders(const Kernel& kernel, std::vector<float>* result) {
  RunOnHost(kernel, HostOrder::kBackward);
  const std::vector<float> backward = *result;
  result->assign(result->size(), kPoison);
  RunOnHost(kernel, HostOrder::kForward);
  EXPECT_EQ(backward, *result) << "the order of blocks and threads matters";
}

// Adds each input's share to the outputs, in double: another order of loops than the kernel's.
std::vector<double> Scattered(const MapShape& s, const std::vector<float>& x,
                              const std::vector<float>& weight) {
  std::vector<double> y(size_t(s.outputs()));
  for (int64_t in = 0; in < s.inputs(); ++in) {
    const int64_t c = in % s.channels, w = in / s.channels % s.width,
                  h = in / s.channels / s.width % s.height,
                  b = in / s.channels / s.width / s.height;
    for (int u = 0; u < s.kernel; ++u) {
      for (int v = 0; v < s.kernel; ++v) {
        const int64_t top = h + s.padding - u, left = w + s.padding - v;
        if (top < 0 || left < 0 || top % s.stride != 0 || left % s.stride != 0) continue;
        const int64_t i = top / s.stride, j = left / s.stride;
        if (i >= s.output_height || j >= s.output_width) continue;
        for (int64_t n = 0; n < s.filters; ++n) {
          const int64_t to = ((b * s.output_height + i) * s.output_width + j) * s.filters + n;
          const int64_t by = ((n * s.kernel + u) * s.kernel + v) * s.channels + c;
          y[size_t(to)] += double(x[size_t(in)]) * double(weight[size_t(by)]);
        }
      }
    }
  }
  return y;
}

double Dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += double(a[i]) * double(b[i]);
  return sum;
}

TEST(MapKernels, ForwardEqualsAConvolutionThatScattersItsInputs) {
  for (const MapShape& s : Shapes()) {
    const auto x = Noise(s.inputs(), 1), weight = Noise(s.weights(), 2), bias = Noise(s.filters, 3);
    std::vector<float> y(size_t(s.outputs()), kPoison);
    RunBothOrders(ConvolveForward{.shape = s,
                                  .x = {.f32 = x.data()},
                                  .weight = {.f32 = weight.data()},
                                  .bias = bias.data(),
                                  .relu = 1,
                                  .y = {.f32 = y.data()}},
                  &y);
    const std::vector<double> expected = Scattered(s, x, weight);
    for (size_t i = 0; i < y.size(); ++i) {
      const double with_bias = expected[i] + double(bias[i % size_t(s.filters)]);
      ASSERT_NEAR(y[i], std::max(0.0, with_bias), 1e-4) << i << " of stride " << s.stride;
    }
  }
}

// For a linear map y(x), the gradient dx = dL/dx of L = <dy, y> satisfies <dx, x> = <dy, y>; the
// same holds for the weights.
TEST(MapKernels, GradientsAreAdjointToTheConvolution) {
  for (const MapShape& s : Shapes()) {
    const auto x = Noise(s.inputs(), 4), weight = Noise(s.weights(), 5), dy = Noise(s.outputs(), 6);
    std::vector<float> y(size_t(s.outputs()), kPoison), dx(size_t(s.inputs()), kPoison),
        dw(size_t(s.weights()), kPoison), dbias(size_t(s.filters), kPoison);
    RunOnHost(ConvolveForward{.shape = s,
                              .x = {.f32 = x.data()},
                              .weight = {.f32 = weight.data()},
                              .y = {.f32 = y.data()}},
              HostOrder::kForward);
    RunBothOrders(ConvolveData{.shape = s,
                               .dy = {.f32 = dy.data()},
                               .weight = {.f32 = weight.data()},
                               .dx = {.f32 = dx.data()}},
                  &dx);
    RunBothOrders(ConvolveWeights{.shape = s,
                                  .x = {.f32 = x.data()},
                                  .dy = {.f32 = dy.data()},
                                  .weight_gradient = dw.data(),
                                  .bias_gradient = dbias.data()},
                  &dw);
    for (int64_t n = 0; n < s.filters; ++n) {
      double sum = 0;
      for (int64_t i = n; i < s.outputs(); i += s.filters) sum += double(dy[size_t(i)]);
      EXPECT_NEAR(dbias[size_t(n)], sum, 1e-4) << "bias " << n;
    }
    const double loss = Dot(dy, y);
    EXPECT_NEAR(Dot(dx, x), loss, 2e-3) << "stride " << s.stride << ", padding " << s.padding;
    EXPECT_NEAR(Dot(dw, weight), loss, 2e-3) << "stride " << s.stride << ", padding " << s.padding;
  }
}

TEST(MapKernels, ABiasIsAddedToEveryRowOfItsGroup) {
  // Two groups of 2 rows and 3 columns; rows are 4 numbers apart, groups 10.
  std::vector<float> y(20, -2);
  const std::vector<float> bias{1, 2, 3, 10, 20, 30};
  RunOnHost(AddBias{.y = {.f32 = y.data()},
                    .bias = bias.data(),
                    .relu = 1,
                    .rows = 2,
                    .columns = 3,
                    .stride = 4,
                    .count = 2,
                    .step = 10,
                    .bias_step = 3},
            HostOrder::kForward);
  EXPECT_EQ(y, (std::vector<float>{0, 0,  1,  -2, 0, 0,  1,  -2, -2, -2,
                                   8, 18, 28, -2, 8, 18, 28, -2, -2, -2}));
}

TEST(MapKernels, ABiasIsAddedToAMapInBf16) {
  // Three pixels of 16 filters: the value of number i is i - 20.
  std::vector<Eight> y(6), expected(6);
  std::vector<float> bias(16);
  for (size_t n = 0; n < bias.size(); ++n) bias[n] = 0.5F * float(n);
  for (int i = 0; i < 48; ++i) {
    y[size_t(i / 8)].numbers[i % 8] = ToBf16(float(i - 20));
    const float sum = float(i - 20) + bias[size_t(i % 16)];
    expected[size_t(i / 8)].numbers[i % 8] = ToBf16(std::max(0.0F, sum));
  }
  RunOnHost(
      AddBiasToMap{
          .y = y.data()->numbers, .bias = bias.data(), .relu = 1, .filters = 16, .size = 48},
      HostOrder::kForward);
  for (int i = 0; i < 48; ++i) {
    EXPECT_EQ(y[size_t(i / 8)].numbers[i % 8], expected[size_t(i / 8)].numbers[i % 8]) << i;
  }
}

TEST(MapKernels, Bf16IsReadAndWidenedExactly) {
  std::vector<uint16_t> narrow;
  for (const float value : {0.0F, -1.5F, 3.140625F}) narrow.push_back(ToBf16(value));
  std::vector<float> wide(3, kPoison);
  RunOnHost(WidenToF32{.from = narrow.data(), .to = wide.data(), .size = 3}, HostOrder::kForward);
  EXPECT_EQ(wide, (std::vector<float>{0, -1.5F, 3.140625F}));
}

}  // namespace
}  // namespace shoal::learner::kernels
