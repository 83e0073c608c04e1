// SPDX-License-Identifier: Apache-2.0
// Compares the kernels of dense layers with the operations of the CPU.
#include "learner/device/kernels/layers.h"

#include <limits>
#include <vector>

#include "common/nn/activations.h"
#include "common/nn/layer_norm.h"
#include "learner/device/kernels/layer_norm.h"
#include "tests/learner/device/kernels/kernel_fixture.h"

namespace shoal::learner::kernels {
namespace {

// Numbers between the parameters of two functions.
constexpr size_t kGap = 5;

// A layer of two functions on the CPU: x plus a bias, LayerNorm, activation.
struct Expected {
  std::vector<float> xhat, rstd, y, dx, dweight, dbias, dlinear_bias;
};

class LayerKernels : public KernelTest {
 protected:
  // Parameters of both functions, which begin columns + kGap apart.
  std::vector<float> Parameters(size_t columns) { return Random(2 * columns + kGap, 0.5, 1.5); }

  static Expected Compute(const nn::RowShape& shape, Activation activation, size_t function,
                          const std::vector<float>& all_x, const std::vector<float>& linear_bias,
                          const std::vector<float>& weight, const std::vector<float>& bias,
                          const std::vector<float>& all_dy) {
    const auto columns = size_t(shape.columns), n = size_t(shape.rows) * columns;
    const size_t parameter = function * (columns + kGap);
    Expected e{std::vector<float>(n),       std::vector<float>(size_t(shape.rows)),
               std::vector<float>(n),       std::vector<float>(n),
               std::vector<float>(columns), std::vector<float>(columns),
               std::vector<float>(columns)};
    std::vector<float> x(all_x.begin() + long(function * n),
                         all_x.begin() + long(function * n + n));
    for (size_t i = 0; i < n; ++i) x[i] += linear_bias[parameter + i % columns];
    const nn::NormWeights weights{weight.data() + parameter, bias.data() + parameter};
    nn::LayerNormForward(shape, x.data(), weights, e.xhat.data(), e.rstd.data(), e.y.data());
    std::vector<float> dz(n);
    const float* dy = all_dy.data() + function * n;
    if (activation == Activation::kTanh) {
      nn::TanhForward(int(n), e.y.data(), e.y.data());
      nn::TanhBackward(int(n), e.y.data(), dy, dz.data());
    } else if (activation == Activation::kElu) {
      nn::EluForward(int(n), e.y.data(), e.y.data());
      nn::EluBackward(int(n), e.y.data(), dy, dz.data());
    } else {
      nn::ReluForward(int(n), e.y.data(), e.y.data());
      nn::ReluBackward(int(n), e.y.data(), dy, dz.data());
    }
    nn::LayerNormBackwardWeights(shape, dz.data(), e.xhat.data(), e.dweight.data(), e.dbias.data());
    nn::LayerNormBackward(shape, dz.data(), weights, e.xhat.data(), e.rstd.data(), e.dx.data());
    for (size_t i = 0; i < n; ++i) e.dlinear_bias[i % columns] += e.dx[i];
    return e;
  }

  void CompareNorm(int rows, int columns, Activation activation);
};

void LayerKernels::CompareNorm(int rows, int columns, Activation activation) {
  const size_t width = size_t(columns), n = size_t(rows) * width;
  const auto step = int64_t(width + kGap);
  const std::vector<float> x = Random(2 * n), dy = Random(2 * n);
  const std::vector<float> linear_bias = Parameters(width), weight = Parameters(width);
  const std::vector<float> bias = Random(2 * width + kGap);
  LayerNormForward forward{.functions = 2,
                           .rows = rows,
                           .columns = columns,
                           .step = step,
                           .x = In(x),
                           .linear_bias = In(linear_bias),
                           .weight = In(weight),
                           .bias = In(bias),
                           .activation = activation,
                           .xhat = Out(2 * n),
                           .rstd = Out(2 * size_t(rows)),
                           .y = {Out(2 * n), Out<uint16_t>(2 * n)}};
  Run(forward);
  LayerNormBackward backward{.functions = 2,
                             .rows = rows,
                             .columns = columns,
                             .step = step,
                             .dy = In(dy),
                             .y = forward.y.f32,
                             .activation = activation,
                             .weight = forward.weight,
                             .xhat = forward.xhat,
                             .rstd = forward.rstd,
                             .dx = {Out(2 * n), Out<uint16_t>(2 * n)}};
  Run(backward);
  const ColumnSums shape{.functions = 2, .rows = rows, .columns = columns};
  ColumnSums sums = shape;
  sums.partials = Out(size_t(3 * shape.PartialsSize()));
  sums.finished = Counters(size_t(shape.groups()));
  LayerNormBackwardWeights of_weights{.sums = sums,
                                      .step = step,
                                      .dy = backward.dy,
                                      .y = forward.y.f32,
                                      .xhat = forward.xhat,
                                      .dx = {backward.dx.f32, nullptr},
                                      .activation = activation,
                                      .dweight = Out(2 * width + kGap),
                                      .dbias = Out(2 * width + kGap),
                                      .dlinear_bias = Out(2 * width + kGap)};
  Run(of_weights);
  for (size_t f = 0; f < 2; ++f) {
    const Expected expected =
        Compute({rows, columns}, activation, f, x, linear_bias, weight, bias, dy);
    const size_t parameter = f * size_t(step);
    ExpectClose(forward.xhat + f * n, expected.xhat, 1e-5);
    ExpectClose(forward.rstd + f * size_t(rows), expected.rstd, 1e-5);
    ExpectClose(forward.y.f32 + f * n, expected.y, 1e-5);
    ExpectClose(FromBf16s(forward.y.bf16 + f * n, n).data(), expected.y, 0.005);
    ExpectClose(backward.dx.f32 + f * n, expected.dx, 1e-5);
    ExpectClose(FromBf16s(backward.dx.bf16 + f * n, n).data(), expected.dx, 0.005);
    ExpectClose(of_weights.dweight + parameter, expected.dweight, 1e-5);
    ExpectClose(of_weights.dbias + parameter, expected.dbias, 1e-5);
    // Gradients before a LayerNorm nearly cancel.
    for (size_t j = 0; j < width; ++j) {
      EXPECT_NEAR(of_weights.dlinear_bias[parameter + j], expected.dlinear_bias[j], 1e-4);
    }
  }
}

TEST_F(LayerKernels, NormsWithAReluOfTwoFunctions) {
  CompareNorm(13, 50, Activation::kRelu);
  CompareNorm(150, 33, Activation::kRelu);  // sums in several parts
  CompareNorm(3, 300, Activation::kRelu);   // several columns for each thread
}

TEST_F(LayerKernels, NormsWithATanh) { CompareNorm(70, 50, Activation::kTanh); }

TEST_F(LayerKernels, NormsWithAnElu) { CompareNorm(70, 50, Activation::kElu); }

TEST_F(LayerKernels, BiasAndActivation) {
  constexpr size_t kRows = 41, kColumns = 37, kNumbers = kRows * kColumns;
  const std::vector<float> x = Random(2 * kNumbers), bias = Parameters(kColumns);
  float* y = Out(2 * kNumbers);
  Run(BiasActivation{.functions = 2,
                     .rows = kRows,
                     .step = kColumns + kGap,
                     .columns = kColumns,
                     .x = {In(x), nullptr},
                     .bias = In(bias),
                     .activation = Activation::kRelu,
                     .y = {y, nullptr}});
  for (size_t i = 0; i < 2 * kNumbers; ++i) {
    const float shift = bias[i / kNumbers * (kColumns + kGap) + i % kColumns];
    ASSERT_EQ(y[i], std::max(0.f, x[i] + shift)) << i;
  }
}

// Gradients through an activation, in bf16 as after a convolution: the sums are those of the
// rounded gradients.
TEST_F(LayerKernels, ActivationsBackwardWithSumsOverManyRows) {
  constexpr size_t kRows = 9001, kColumns = 35, kNumbers = kRows * kColumns;
  std::vector<uint16_t> y, dy;
  for (const float value : Random(kNumbers)) y.push_back(ToBf16(std::max(0.f, value)));
  for (const float value : Random(kNumbers)) dy.push_back(ToBf16(value));
  ColumnSums sums{.rows = kRows, .columns = kColumns};
  ASSERT_GT(sums.parts(), 2);
  sums.partials = Out(size_t(sums.PartialsSize()));
  sums.finished = Counters(size_t(sums.groups()));
  auto* dx = Out<uint16_t>(kNumbers);
  float* dbias = Out(kColumns);
  Run(ActivationBackward{.sums = sums,
                         .dy = {nullptr, In(dy)},
                         .y = {nullptr, In(y)},
                         .activation = Activation::kRelu,
                         .dx = {nullptr, dx},
                         .dbias = dbias});
  std::vector<double> expected(kColumns, 0);
  for (size_t i = 0; i < kNumbers; ++i) {
    const uint16_t gradient = FromBf16(y[i]) > 0 ? dy[i] : uint16_t(0);
    ASSERT_EQ(dx[i], gradient) << i;
    expected[i % kColumns] += FromBf16(gradient);
  }
  for (size_t j = 0; j < kColumns; ++j) EXPECT_NEAR(dbias[j], expected[j], 2e-3);
}

TEST_F(LayerKernels, ReluStopsGradientsWhereItsOutputIsZero) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (const size_t size : {40, 43}) {  // with eights of bf16 numbers, and without
    std::vector<float> dy = Random(size), y = Random(size);
    for (size_t i = 0; i < size; i += 3) y[i] = 0;
    dy[0] = kInfinity;
    std::vector<float> expected = dy;
    std::vector<uint16_t> narrow_dy, narrow_y, narrow_expected;
    for (size_t i = 0; i < size; ++i) {
      if (!(y[i] > 0)) expected[i] = 0;
      narrow_dy.push_back(ToBf16(dy[i]));
      narrow_y.push_back(ToBf16(y[i]));
      narrow_expected.push_back(ToBf16(expected[i]));
    }
    float* dx = Out(size);
    Run(ReluBackward{
        .n = int64_t(size), .dy = {In(dy), nullptr}, .y = {In(y), nullptr}, .dx = {dx, nullptr}});
    EXPECT_EQ(std::vector<float>(dx, dx + size), expected);
    auto* narrow = Out<uint16_t>(size);
    Run(ReluBackward{.n = int64_t(size),
                     .dy = {nullptr, In(narrow_dy)},
                     .y = {nullptr, In(narrow_y)},
                     .dx = {nullptr, narrow}});
    EXPECT_EQ(std::vector<uint16_t>(narrow, narrow + size), narrow_expected);
  }
}

TEST_F(LayerKernels, SumsOfRoundedGradients) {
  constexpr size_t kRows = 5, kColumns = 3;
  const std::vector<float> dy = Random(2 * kRows * kColumns);
  auto* dx = Out<uint16_t>(dy.size());
  float* dbias = Out(2 * kColumns);
  Run(ActivationBackward{.sums = {.functions = 2, .rows = kRows, .columns = kColumns},
                         .step = kColumns,
                         .dy = {In(dy), nullptr},
                         .dx = {nullptr, dx},
                         .dbias = dbias});
  std::vector<float> expected(2 * kColumns, 0.f);
  for (size_t i = 0; i < dy.size(); ++i) {
    expected[i / (kRows * kColumns) * kColumns + i % kColumns] += FromBf16(ToBf16(dy[i]));
  }
  ExpectClose(dbias, expected, 1e-6);
}

}  // namespace
}  // namespace shoal::learner::kernels
