// SPDX-License-Identifier: Apache-2.0
#include "common/nn/conv.h"

#include "common/nn/relu_mask.h"
#include "tests/common/nn/layer_fixture.h"

namespace shoal::nn {
namespace {

using reference::ConvShape;
using reference::Values;

class ConvTest : public LayerTest {
 protected:
  // Forward and backward of one layer, against the reference.
  void Compare(const ConvShape& shape) {
    NetworkPlan plan({shape.channels, shape.height, shape.width});
    plan.Add(
        NetworkPlan::Convolution{.name = "conv",
                                 .key = "network.filters",
                                 .filters = shape.filters,
                                 .kernel = shape.kernel,
                                 .stride = shape.stride,
                                 .padding = shape.padding,
                                 .activation = shape.relu ? Activation::kRelu : Activation::kNone});
    ParameterSet parameters(plan.Parameters(), ParameterSet::Use::kTraining);
    const size_t weights = Count(parameters.Find("conv.weight"));
    Randomise(&parameters, 1, 0.5);
    const float* weight_values = parameters.Find("conv.weight").value();
    const float* bias_values = parameters.Find("conv.bias").value();
    const Values weight = ToDoubles({weight_values, weights});
    const Values bias = ToDoubles({bias_values, size_t(shape.filters)});
    const Values x =
        RandomValues(size_t(shape.batch) * shape.channels * shape.height * shape.width, 2);

    const dnnl::memory source =
        MakeMemory(dnnl::memory::desc({shape.batch, shape.channels, shape.height, shape.width},
                                      ComputeType(GetParam()), dnnl::memory::format_tag::nchw));
    const dnnl::memory source_gradient = MakeMemory(source.get_desc());
    Conv conv(Context(parameters, shape.batch), plan.layers()[0], source, source_gradient);
    conv.Refresh();
    FillMemory(x, source);
    conv.Forward(Statistics::kBatch);
    const Values y = reference::ConvForward(shape, x, weight, bias);
    EXPECT_LT(RelativeError(ReadMemory(conv.output()), y), Tolerance(GetParam()));

    // Masked by the layer's own output: in bf16 a sum near zero may round to the other side.
    const Values dy = RandomValues(y.size(), 3);
    FillMemory(dy, conv.output_gradient());
    const Values mask = ToDoubles(ReadMemory(conv.output()));
    conv.Backward();
    const auto exact = reference::ConvBackward(shape, x, weight, mask, dy);
    EXPECT_LT(RelativeError(GradientOf(parameters, "conv.weight"), exact.weight),
              Tolerance(GetParam()));
    EXPECT_LT(RelativeError(GradientOf(parameters, "conv.bias"), exact.bias),
              Tolerance(GetParam()));
    EXPECT_LT(RelativeError(ReadMemory(source_gradient), exact.source), Tolerance(GetParam()));
  }
};

TEST_P(ConvTest, AgreesWithTheReferenceOnOddSizes) {
  Compare({.batch = 3, .channels = 5, .height = 11, .width = 9, .filters = 7, .stride = 1});
}

TEST_P(ConvTest, AgreesWithTheReferenceWhereTheStrideLeavesARemainder) {
  Compare({.batch = 2, .channels = 3, .height = 12, .width = 10, .filters = 20, .stride = 2});
}

TEST_P(ConvTest, AgreesWithTheReferenceOnTheDefaultNetworksInnerLayer) {
  Compare({.batch = 2, .channels = 32, .height = 20, .width = 20, .filters = 32, .stride = 1});
}

TEST_P(ConvTest, AgreesWithTheReferenceOnOneGreyChannelAndAOneByOneMap) {
  Compare({.batch = 2, .channels = 1, .height = 3, .width = 3, .filters = 4, .stride = 1});
}

TEST_P(ConvTest, AgreesWithTheReferenceOnLargeKernelsAndStrides) {
  Compare({.batch = 2,
           .channels = 3,
           .height = 37,
           .width = 30,
           .filters = 9,
           .stride = 4,
           .kernel = 8});
  Compare({.batch = 2,
           .channels = 32,
           .height = 9,
           .width = 8,
           .filters = 17,
           .stride = 2,
           .kernel = 4});
}

TEST_P(ConvTest, AgreesWithTheReferenceWithPadding) {
  Compare({.batch = 2,
           .channels = 5,
           .height = 7,
           .width = 9,
           .filters = 6,
           .stride = 1,
           .kernel = 3,
           .padding = 1});
  Compare({.batch = 2,
           .channels = 3,
           .height = 15,
           .width = 13,
           .filters = 8,
           .stride = 2,
           .kernel = 7,
           .padding = 3});
  Compare(
      {.batch = 2, .channels = 4, .height = 6, .width = 5, .filters = 3, .stride = 2, .kernel = 1});
}

TEST_P(ConvTest, AgreesWithTheReferenceWithoutRelu) {
  Compare({.batch = 3,
           .channels = 5,
           .height = 11,
           .width = 9,
           .filters = 7,
           .stride = 1,
           .relu = false});
}

INSTANTIATE_PRECISIONS(ConvTest);

TEST(ReluMask, ZeroesTheGradientWhereTheOutputIsZeroAndNowhereElse) {
  const std::vector<float> y{0.f, 1e-38f, 5.f, 0.f, -0.f};
  std::vector<float> dy{1, -2, 3, -4, 5};
  MaskWhereZero(y.data(), int64_t(y.size()), dy.data());
  EXPECT_EQ(dy, (std::vector<float>{0, -2, 3, 0, 0}));

  const std::vector<uint16_t> y16{0x0000, 0x0001, 0x3f80, 0x8000};  // 0, smallest, 1, -0
  std::vector<uint16_t> dy16{0x3f80, 0xbf80, 0x3f80, 0x3f80};
  MaskWhereZero(y16.data(), int64_t(y16.size()), dy16.data());
  EXPECT_EQ(dy16, (std::vector<uint16_t>{0, 0xbf80, 0x3f80, 0}));
}

}  // namespace
}  // namespace shoal::nn
