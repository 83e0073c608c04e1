// SPDX-License-Identifier: Apache-2.0
#include "common/nn/layer_norm.h"

#include "common/nn/parallel.h"
#include "tests/common/nn/gradient_check.h"

namespace shoal::nn {
namespace {

using reference::Values;

constexpr double kF32 = 2e-5;

struct RowsCase {
  int rows, columns;
};

class LayerNormTest : public testing::TestWithParam<RowsCase> {
 protected:
  const int rows_ = GetParam().rows, columns_ = GetParam().columns;
  const size_t size_ = static_cast<size_t>(rows_ * columns_);
  const Values x_ = RandomValues(size_, 1),
               weight_ = RandomValues(static_cast<size_t>(columns_), 2);
  const Values bias_ = RandomValues(static_cast<size_t>(columns_), 3), dy_ = RandomValues(size_, 4);
};

TEST_P(LayerNormTest, ForwardAndBackwardAgreeWithTheReference) {
  const std::vector<float> x = ToFloats(x_), weight = ToFloats(weight_), bias = ToFloats(bias_);
  const RowShape shape{rows_, columns_};
  const NormWeights weights{weight.data(), bias.data()};
  std::vector<float> xhat(size_), y(size_), rstd(static_cast<size_t>(rows_));
  LayerNormForward(shape, x.data(), weights, xhat.data(), rstd.data(), y.data());
  EXPECT_LT(RelativeError(y, reference::LayerNormForward(rows_, x_, weight_, bias_)), kF32);

  std::vector<float> dx = ToFloats(dy_), dweight(weight.size()), dbias(weight.size());
  LayerNormBackwardWeights(shape, dx.data(), xhat.data(), dweight.data(), dbias.data());
  LayerNormBackward(shape, dx.data(), weights, xhat.data(), rstd.data(), dx.data());
  const auto exact = reference::LayerNormBackward(rows_, x_, weight_, dy_);
  EXPECT_LT(RelativeError(dx, exact.source), kF32);
  EXPECT_LT(RelativeError(dweight, exact.weight), kF32);
  EXPECT_LT(RelativeError(dbias, exact.bias), kF32);
}

TEST_P(LayerNormTest, ResultIsTheSameForAnyNumberOfThreads) {
  const std::vector<float> x = ToFloats(x_), weight = ToFloats(weight_);
  const NormWeights weights{weight.data(), weight.data()};
  std::vector<std::vector<float>> results;
  for (const int threads : {1, 2, 3}) {
    const ThreadScope scope(threads);
    std::vector<float> xhat(size_), y(size_), rstd(static_cast<size_t>(rows_));
    LayerNormForward({rows_, columns_}, x.data(), weights, xhat.data(), rstd.data(), y.data());
    LayerNormBackward({rows_, columns_}, y.data(), weights, xhat.data(), rstd.data(), y.data());
    results.push_back(y);
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

// The last case is large enough to be split over threads.
INSTANTIATE_TEST_SUITE_P(Sizes, LayerNormTest,
                         testing::Values(RowsCase{3, 7}, RowsCase{5, 50}, RowsCase{1, 17},
                                         RowsCase{513, 257}),
                         [](const auto& test) {
                           return std::to_string(test.param.rows) + "x" +
                                  std::to_string(test.param.columns);
                         });

TEST(LayerNorm, ARowOfEqualValuesBecomesTheBias) {
  const std::vector<float> x(6, 1000.f), weight(6, 2.f), bias(6, 0.25f);
  std::vector<float> xhat(6), y(6), rstd(1);
  LayerNormForward({1, 6}, x.data(), {weight.data(), bias.data()}, xhat.data(), rstd.data(),
                   y.data());
  EXPECT_EQ(y, bias);
}

TEST(Relu, KeepsPositivesZeroesNegativesAndLetsNanThrough) {
  const std::vector<float> x{-1.f, 0.f, 2.f, NAN};
  std::vector<float> y(4);
  ReluForward(4, x.data(), y.data());
  EXPECT_EQ(std::vector<float>(y.begin(), y.begin() + 3), (std::vector<float>{0, 0, 2}));
  EXPECT_TRUE(std::isnan(y[3]));
}

TEST(Relu, GradientPassesWhereTheOutputIsPositive) {
  const std::vector<float> y{0, 3, 0, 1}, dy{1, 2, 3, 4};
  std::vector<float> dx(4);
  ReluBackward(4, y.data(), dy.data(), dx.data());
  EXPECT_EQ(dx, (std::vector<float>{0, 2, 0, 4}));
}

TEST(Elu, AgreesWithTheLibraryAndItsGradientWithCentralDifferences) {
  std::vector<float> x, y(201), dx(201), ones(201, 1.f);
  for (int i = -100; i <= 100; ++i) x.push_back(static_cast<float>(i) * 0.1f + 0.05f);
  EluForward(201, x.data(), y.data());
  EluBackward(201, y.data(), ones.data(), dx.data());
  const auto elu = [](double value) { return value > 0 ? value : std::expm1(value); };
  for (size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(y[i], elu(x[i]), 1e-6);
    double value = x[i];
    EXPECT_NEAR(dx[i], CentralDifference(&value, [&] { return elu(value); }), 2e-6);
  }
  EluForward(201, x.data(), x.data());
  EXPECT_EQ(x, y) << "in place";
}

TEST(Elu, LetsNanThroughAndEndsAtMinusOne) {
  const std::vector<float> x{NAN, -1000.f, -INFINITY, 3e38f};
  std::vector<float> y(4), dx(4);
  const std::vector<float> ones(4, 1.f);
  EluForward(4, x.data(), y.data());
  EXPECT_TRUE(std::isnan(y[0]));
  EXPECT_EQ(std::vector<float>(y.begin() + 1, y.end()), (std::vector<float>{-1, -1, 3e38f}));
  EluBackward(4, y.data(), ones.data(), dx.data());
  EXPECT_TRUE(std::isnan(dx[0]));
  EXPECT_EQ(std::vector<float>(dx.begin() + 1, dx.end()), (std::vector<float>{0, 0, 1}));
}

TEST(Tanh, AgreesWithTheLibraryAndItsGradientWithCentralDifferences) {
  std::vector<float> x, y(201), dx(201), ones(201, 1.f);
  for (int i = -100; i <= 100; ++i) x.push_back(static_cast<float>(i) * 0.1f);
  TanhForward(201, x.data(), y.data());
  TanhBackward(201, y.data(), ones.data(), dx.data());
  for (size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(y[i], std::tanh(static_cast<double>(x[i])), 1e-6);
    double value = x[i];
    EXPECT_NEAR(dx[i], CentralDifference(&value, [&] { return std::tanh(value); }), 2e-6);
  }
}

}  // namespace
}  // namespace shoal::nn
