// SPDX-License-Identifier: Apache-2.0
#include "common/nn/linear.h"

#include "tests/common/nn/layer_fixture.h"

namespace shoal::nn {
namespace {

using reference::Values;

constexpr int kInputRows = 5, kInputs = 13, kOutputs = 7;

class LinearTest : public LayerTest {
 protected:
  LinearTest()
      : parameters_({{"fc.weight", {kOutputs, kInputs}}, {"fc.bias", {kOutputs}}},
                    ParameterSet::Use::kTraining),
        x_(RandomValues(kInputRows * kInputs, 2)) {
    Randomise(&parameters_, 1, 0.5);
    weight_ = ToDoubles({parameters_.Find("fc.weight").value(), kOutputs * kInputs});
    bias_ = ToDoubles({parameters_.Find("fc.bias").value(), kOutputs});
  }

  ParameterSet parameters_;
  Values x_, weight_, bias_;
};

TEST_P(LinearTest, ForwardAndBackwardAgreeWithTheReference) {
  Rows source(kInputRows, kInputs, GetParam()), gradient(kInputRows, kInputs, Precision::kF32);
  Linear linear(Context(parameters_, kInputRows), "fc", source.compute(), gradient.f32());
  linear.Refresh();
  source.SetColumns(0, kInputs, ToFloats(x_).data());
  source.Commit();
  linear.Forward();
  EXPECT_LT(RelativeError({linear.output().values(), kInputRows * kOutputs},
                          reference::LinearForward(kInputRows, x_, weight_, bias_)),
            Tolerance(GetParam()));

  const Values dy = RandomValues(kInputRows * kOutputs, 3);
  std::copy(dy.begin(), dy.end(), linear.output_gradient().values());
  linear.Backward({});
  const auto exact = reference::LinearBackward(kInputRows, x_, weight_, dy);
  EXPECT_LT(RelativeError(GradientOf(parameters_, "fc.weight"), exact.weight),
            Tolerance(GetParam()));
  EXPECT_LT(RelativeError(GradientOf(parameters_, "fc.bias"), exact.bias), Tolerance(GetParam()));
  EXPECT_LT(RelativeError({gradient.values(), kInputRows * kInputs}, exact.source),
            Tolerance(GetParam()));
}

TEST_P(LinearTest, BackwardComputesOnlyTheGradientsAskedFor) {
  Rows source(kInputRows, kInputs, GetParam()), gradient(kInputRows, kInputs, Precision::kF32);
  Linear linear(Context(parameters_, kInputRows), "fc", source.compute(), gradient.f32());
  linear.Refresh();
  source.SetColumns(0, kInputs, ToFloats(x_).data());
  source.Commit();
  linear.Forward();
  std::fill_n(linear.output_gradient().values(), kInputRows * kOutputs, 1.f);
  const auto all_zero = [](std::span<const float> values) {
    return std::all_of(values.begin(), values.end(), [](float value) { return value == 0; });
  };

  linear.Backward({.parameters = false, .source = true});
  EXPECT_TRUE(all_zero(GradientOf(parameters_, "fc.weight")));
  EXPECT_FALSE(all_zero({gradient.values(), kInputRows * kInputs}));

  std::fill_n(gradient.values(), kInputRows * kInputs, 0.f);
  linear.Backward({.parameters = true, .source = false});
  EXPECT_FALSE(all_zero(GradientOf(parameters_, "fc.weight")));
  EXPECT_TRUE(all_zero({gradient.values(), kInputRows * kInputs}));
}

TEST_P(LinearTest, UsesTheNewValuesAfterRefresh) {
  Rows source(kInputRows, kInputs, GetParam());
  Linear linear(Context(parameters_, kInputRows, /*training=*/false), "fc", source.compute(), {});
  linear.Refresh();
  std::fill_n(parameters_.values(), parameters_.size(), 0.f);
  linear.Refresh();
  source.SetColumns(0, kInputs, ToFloats(x_).data());
  source.Commit();
  linear.Forward();
  EXPECT_EQ(std::vector<float>(linear.output().values(),
                               linear.output().values() + kInputRows * kOutputs),
            std::vector<float>(kInputRows * kOutputs, 0.f));
}

INSTANTIATE_PRECISIONS(LinearTest);

}  // namespace
}  // namespace shoal::nn
