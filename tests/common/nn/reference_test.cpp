// SPDX-License-Identifier: Apache-2.0
// The naive reference itself: its gradients against central differences.
#include "tests/common/nn/reference.h"

#include "tests/common/nn/gradient_check.h"

namespace shoal::nn::reference {
namespace {

void ExpectGradient(const Values& gradient, Values* values, const std::function<double()>& loss) {
  ASSERT_EQ(gradient.size(), values->size());
  for (size_t i = 0; i < values->size(); ++i) {
    EXPECT_NEAR(gradient[i], CentralDifference(&(*values)[i], loss), 1e-7) << "element " << i;
  }
}

TEST(Reference, ConvolutionOfOneWindowIsAHandComputedSum) {
  const ConvShape shape{1, 1, 3, 3, 1, 1};
  const Values x{1, 2, 3, 4, 5, 6, 7, 8, 9}, weight{1, 0, 0, 0, 1, 0, 0, 0, -1};
  EXPECT_EQ(ConvForward(shape, x, weight, {0.5}), Values{0});  // 1 + 5 - 9 + 0.5 < 0
  EXPECT_EQ(ConvForward(shape, x, weight, {4}), Values{1});
}

TEST(Reference, ConvolutionGradientIsTheCentralDifference) {
  const ConvShape shape{2, 2, 6, 5, 3, 2};
  Values x = RandomValues(2 * 2 * 6 * 5, 1), weight = RandomValues(3 * 2 * 9, 2);
  Values bias = RandomValues(3, 3);
  const Values y = ConvForward(shape, x, weight, bias);
  const Values dy = RandomValues(y.size(), 4);
  const auto loss = [&] { return Dot(dy, ConvForward(shape, x, weight, bias)); };
  const Gradient gradient = ConvBackward(shape, x, weight, y, dy);
  ExpectGradient(gradient.source, &x, loss);
  ExpectGradient(gradient.weight, &weight, loss);
  ExpectGradient(gradient.bias, &bias, loss);
}

TEST(Reference, LinearGradientIsTheCentralDifference) {
  Values x = RandomValues(3 * 5, 1), weight = RandomValues(4 * 5, 2), bias = RandomValues(4, 3);
  const Values dy = RandomValues(3 * 4, 4);
  const auto loss = [&] { return Dot(dy, LinearForward(3, x, weight, bias)); };
  const Gradient gradient = LinearBackward(3, x, weight, dy);
  ExpectGradient(gradient.source, &x, loss);
  ExpectGradient(gradient.weight, &weight, loss);
  ExpectGradient(gradient.bias, &bias, loss);
}

TEST(Reference, LayerNormGradientIsTheCentralDifference) {
  Values x = RandomValues(3 * 7, 1), weight = RandomValues(7, 2), bias = RandomValues(7, 3);
  const Values dy = RandomValues(3 * 7, 4);
  const auto loss = [&] { return Dot(dy, LayerNormForward(3, x, weight, bias)); };
  const Gradient gradient = LayerNormBackward(3, x, weight, dy);
  ExpectGradient(gradient.source, &x, loss);
  ExpectGradient(gradient.weight, &weight, loss);
  ExpectGradient(gradient.bias, &bias, loss);
}

}  // namespace
}  // namespace shoal::nn::reference
