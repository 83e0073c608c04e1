// SPDX-License-Identifier: Apache-2.0
#include "common/nn/activations.h"

#include <cmath>
#include <vector>

#include "tests/common/nn/gradient_check.h"

namespace shoal::nn {
namespace {

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
