// SPDX-License-Identifier: Apache-2.0
// Max and average pooling of maps.
#include "common/nn/average_pool.h"
#include "common/nn/max_pool.h"
#include "tests/common/nn/layer_fixture.h"

namespace shoal::nn {
namespace {

using reference::Values;

constexpr int kPoolImages = 2, kPoolChannels = 5;

class PoolTest : public LayerTest {
 protected:
  static dnnl::memory Map(const MapShape& shape) {
    return MakeMemory(dnnl::memory::desc({kPoolImages, shape.channels, shape.height, shape.width},
                                         ComputeType(GetParam()), dnnl::memory::format_tag::nchw));
  }

  // Values that bf16 holds, so that the largest of a window is the same one in both precisions.
  static Values Levels(size_t n, uint64_t key) {
    Values values = RandomValues(n, key);
    for (double& value : values) value = std::round(value * 50) / 32;
    return values;
  }

  void CompareMax(int height, int width, int kernel, int stride, int padding) {
    NetworkPlan plan({kPoolChannels, height, width});
    plan.Add(NetworkPlan::MaxPool{
        .name = "pool", .key = "k", .kernel = kernel, .stride = stride, .padding = padding});
    const dnnl::memory source = Map(plan.input()), gradient = Map(plan.input());
    ParameterSet none({}, ParameterSet::Use::kTraining);
    MaxPool pool(Context(none, kPoolImages), plan.layers()[0], source, gradient);
    const reference::PoolShape shape{
        kPoolImages * kPoolChannels, height, width, kernel, stride, padding};
    // Below zero alone: what lies outside of the map is no zero.
    Values x = Levels(size_t(shape.planes * height * width), 1);
    for (double& value : x) value -= 4;
    FillMemory(x, source);
    pool.Forward(Statistics::kBatch);
    EXPECT_EQ(ToDoubles(ReadMemory(pool.output())), reference::MaxPoolForward(shape, x));

    const Values dy =
        RandomValues(size_t(shape.planes * shape.out_height() * shape.out_width()), 2);
    FillMemory(dy, pool.output_gradient());
    pool.Backward();
    EXPECT_LT(RelativeError(ReadMemory(gradient), reference::MaxPoolBackward(shape, x, dy)),
              Tolerance(GetParam()));
  }

  void CompareAverage(int height, int width, int out_height, int out_width) {
    NetworkPlan plan({kPoolChannels, height, width});
    plan.Add(NetworkPlan::AveragePool{
        .name = "pool", .key = "k", .height = out_height, .width = out_width});
    const dnnl::memory source = Map(plan.input()), gradient = Map(plan.input());
    ParameterSet none({}, ParameterSet::Use::kTraining);
    AveragePool pool(Context(none, kPoolImages), plan.layers()[0], source, gradient);
    const reference::AveragePoolShape shape{kPoolImages * kPoolChannels, height, width, out_height,
                                            out_width};
    const Values x = RandomValues(size_t(shape.planes * height * width), 1);
    FillMemory(x, source);
    pool.Forward(Statistics::kBatch);
    EXPECT_LT(RelativeError(ReadMemory(pool.output()), reference::AveragePoolForward(shape, x)),
              Tolerance(GetParam()));

    const Values dy = RandomValues(size_t(shape.planes * out_height * out_width), 2);
    FillMemory(dy, pool.output_gradient());
    pool.Backward();
    EXPECT_LT(RelativeError(ReadMemory(gradient), reference::AveragePoolBackward(shape, dy)),
              Tolerance(GetParam()));
  }
};

TEST_P(PoolTest, MaximaAndTheirGradientsAgreeWithTheReference) {
  CompareMax(9, 12, 3, 2, 0);
  CompareMax(9, 12, 3, 2, 1);
  CompareMax(3, 3, 3, 2, 0);
}

TEST_P(PoolTest, AveragesAgreeWithTheReferenceWhereWindowsFitOverlapAndRepeat) {
  CompareAverage(6, 9, 2, 3);
  CompareAverage(7, 8, 6, 6);
  CompareAverage(1, 2, 6, 6);
  CompareAverage(5, 3, 1, 1);
}

INSTANTIATE_PRECISIONS(PoolTest);

}  // namespace
}  // namespace shoal::nn
