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

}  // namespace
}  // namespace shoal::nn
