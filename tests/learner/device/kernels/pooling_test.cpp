// SPDX-License-Identifier: Apache-2.0
#include "learner/device/kernels/pooling.h"

#include <cmath>
#include <vector>

#include "tests/learner/device/kernels/kernel_fixture.h"

namespace shoal::learner::kernels {
namespace {

// Odd sizes; the outputs of a max pool are set by its window.
PoolShape MaxShape(int kernel, int stride, int padding) {
  PoolShape shape{.batch = 3,
                  .channels = 19,
                  .height = 9,
                  .width = 8,
                  .kernel = kernel,
                  .stride = stride,
                  .padding = padding};
  shape.output_height = (shape.height + 2 * padding - kernel) / stride + 1;
  shape.output_width = (shape.width + 2 * padding - kernel) / stride + 1;
  return shape;
}

// Windows that overlap and reach over the border, that overlap, that touch, that leave gaps.
std::vector<PoolShape> MaxShapes() {
  return {MaxShape(3, 2, 1), MaxShape(3, 2, 0), MaxShape(2, 2, 0), MaxShape(2, 3, 0)};
}

PoolShape AverageShape(int height, int width, int to_height, int to_width) {
  return {.batch = 3,
          .channels = 19,
          .height = height,
          .width = width,
          .output_height = to_height,
          .output_width = to_width};
}

// Windows that overlap, one window, a map that is smaller than the output.
std::vector<PoolShape> AverageShapes() {
  return {AverageShape(7, 5, 3, 2), AverageShape(4, 6, 1, 1), AverageShape(2, 3, 5, 6)};
}

size_t InputAt(const PoolShape& s, int b, int u, int v, int c) {
  return ((size_t(b) * s.height + u) * s.width + v) * s.channels + c;
}

// Calls body(output, row, i, j, channel) for all numbers of the output, in order.
template <class Body>
void ForOutputs(const PoolShape& s, const Body& body) {
  size_t at = 0;
  for (int b = 0; b < s.batch; ++b) {
    for (int i = 0; i < s.output_height; ++i) {
      for (int j = 0; j < s.output_width; ++j) {
        for (int c = 0; c < s.channels; ++c) body(at++, b, i, j, c);
      }
    }
  }
}

// Inputs of window i along one side.
struct Side {
  int begin, end;
};
Side MaxSide(int i, int side, const PoolShape& s) {
  const int first = i * s.stride - s.padding;
  return {std::max(first, 0), std::min(first + s.kernel, side)};
}
Side AverageSide(int i, int side, int outputs) {
  return {int(std::floor(double(i) * side / outputs)),
          int(std::ceil(double(i + 1) * side / outputs - 1e-9))};
}

// The first of the largest inputs of each window.
std::vector<size_t> Winners(const PoolShape& s, const std::vector<float>& x) {
  std::vector<size_t> winners;
  ForOutputs(s, [&](size_t, int b, int i, int j, int c) {
    const Side rows = MaxSide(i, s.height, s), columns = MaxSide(j, s.width, s);
    size_t winner = InputAt(s, b, rows.begin, columns.begin, c);
    for (int u = rows.begin; u < rows.end; ++u) {
      for (int v = columns.begin; v < columns.end; ++v) {
        const size_t at = InputAt(s, b, u, v, c);
        if (x[at] > x[winner]) winner = at;
      }
    }
    winners.push_back(winner);
  });
  return winners;
}

class PoolingKernels : public KernelTest {
 protected:
  // Numbers of few values, so that windows have several largest ones.
  std::vector<float> Coarse(size_t n) {
    std::vector<float> values = Random(n, -3, 3);
    for (float& value : values) value = std::round(value);
    return values;
  }
};

TEST_F(PoolingKernels, TheLargestNumberOfAWindowGetsItsGradient) {
  for (const PoolShape& s : MaxShapes()) {
    const auto inputs = size_t(s.inputs()), outputs = size_t(s.outputs());
    const std::vector<float> x = Coarse(inputs), dy = Random(outputs);
    float *y = Out(outputs), *dx = Out(inputs);
    auto* winners = Out<uint8_t>(outputs);
    Run(MaxPoolForward{.shape = s, .x = {In(x), nullptr}, .y = {y, nullptr}, .winners = winners});
    Run(MaxPoolBackward{
        .shape = s, .winners = winners, .dy = {In(dy), nullptr}, .dx = {dx, nullptr}});
    std::vector<double> expected(inputs);
    const std::vector<size_t> of_window = Winners(s, x);
    for (size_t at = 0; at < outputs; ++at) {
      ASSERT_EQ(y[at], x[of_window[at]]) << at;
      expected[of_window[at]] += double(dy[at]);
    }
    for (size_t at = 0; at < inputs; ++at) ASSERT_NEAR(dx[at], expected[at], 1e-6) << at;
    float* alone = Out(outputs);
    Run(MaxPoolForward{.shape = s, .x = {In(x), nullptr}, .y = {alone, nullptr}});
    for (size_t at = 0; at < outputs; ++at) ASSERT_EQ(alone[at], y[at]) << at;
  }
}

TEST_F(PoolingKernels, NumbersThatAreNotFiniteAreFound) {
  const PoolShape s = MaxShape(3, 2, 1);
  std::vector<float> x = Random(size_t(s.inputs()), -2, -1);
  x[InputAt(s, 1, 4, 4, 7)] = NAN;
  float* y = Out(size_t(s.outputs()));
  Run(MaxPoolForward{.shape = s, .x = {In(x), nullptr}, .y = {y, nullptr}});
  ForOutputs(s, [&](size_t at, int b, int i, int j, int c) {
    const Side rows = MaxSide(i, s.height, s), columns = MaxSide(j, s.width, s);
    const bool in = b == 1 && c == 7 && rows.begin <= 4 && 4 < rows.end && columns.begin <= 4 &&
                    4 < columns.end;
    ASSERT_EQ(std::isnan(y[at]), in) << at;
  });
}

TEST_F(PoolingKernels, AveragesAndTheirGradients) {
  for (const PoolShape& s : AverageShapes()) {
    const auto inputs = size_t(s.inputs()), outputs = size_t(s.outputs());
    const std::vector<float> x = Random(inputs), dy = Random(outputs);
    float *y = Out(outputs), *dx = Out(inputs);
    Run(AveragePoolForward{.shape = s, .x = {In(x), nullptr}, .y = {y, nullptr}});
    Run(AveragePoolBackward{.shape = s, .dy = {In(dy), nullptr}, .dx = {dx, nullptr}});
    std::vector<double> expected(inputs);
    ForOutputs(s, [&](size_t at, int b, int i, int j, int c) {
      const Side rows = AverageSide(i, s.height, s.output_height);
      const Side columns = AverageSide(j, s.width, s.output_width);
      const int count = (rows.end - rows.begin) * (columns.end - columns.begin);
      double sum = 0;
      for (int u = rows.begin; u < rows.end; ++u) {
        for (int v = columns.begin; v < columns.end; ++v) {
          sum += double(x[InputAt(s, b, u, v, c)]);
          expected[InputAt(s, b, u, v, c)] += double(dy[at]) / count;
        }
      }
      ASSERT_NEAR(y[at], sum / count, 1e-6) << at;
    });
    for (size_t at = 0; at < inputs; ++at) ASSERT_NEAR(dx[at], expected[at], 2e-6) << at;
  }
}

// Results in bf16 are those of f32, rounded once.
TEST_F(PoolingKernels, Bf16IsReadAndWritten) {
  const PoolShape max = MaxShape(3, 2, 1), average = AverageShape(7, 5, 3, 2);
  for (const PoolShape& s : {max, average}) {
    std::vector<uint16_t> x, dy;
    for (const float value : Coarse(size_t(s.inputs()))) x.push_back(ToBf16(value));
    for (const float value : Random(size_t(s.outputs()))) dy.push_back(ToBf16(value));
    const auto run = [&](const Source& from, const Source& gradient, const Target& to,
                         const Target& result) {
      if (s == average) {
        Run(AveragePoolForward{.shape = s, .x = from, .y = to});
        Run(AveragePoolBackward{.shape = s, .dy = gradient, .dx = result});
        return;
      }
      auto* winners = Out<uint8_t>(size_t(s.outputs()));
      Run(MaxPoolForward{.shape = s, .x = from, .y = to, .winners = winners});
      Run(MaxPoolBackward{.shape = s, .winners = winners, .dy = gradient, .dx = result});
    };
    auto *y = Out<uint16_t>(dy.size()), *dx = Out<uint16_t>(x.size());
    float *wide_y = Out(dy.size()), *wide_dx = Out(x.size());
    run({nullptr, In(x)}, {nullptr, In(dy)}, {nullptr, y}, {nullptr, dx});
    run({In(FromBf16s(x.data(), x.size())), nullptr},
        {In(FromBf16s(dy.data(), dy.size())), nullptr}, {wide_y, nullptr}, {wide_dx, nullptr});
    for (size_t i = 0; i < dy.size(); ++i) ASSERT_EQ(y[i], ToBf16(wide_y[i])) << i;
    for (size_t i = 0; i < x.size(); ++i) ASSERT_EQ(dx[i], ToBf16(wide_dx[i])) << i;
  }
}

}  // namespace
}  // namespace shoal::learner::kernels
