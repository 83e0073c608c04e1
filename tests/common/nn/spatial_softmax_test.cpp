// SPDX-License-Identifier: Apache-2.0
// Points of maps and their gradients.
#include "common/nn/spatial_softmax.h"

#include <cmath>

#include "tests/common/nn/layer_fixture.h"

namespace shoal::nn {
namespace {

using reference::Values;

constexpr int kStacks = 2, kPlanes = 5;
constexpr double kSharpness = 3;

class SpatialSoftmaxTest : public LayerTest {
 protected:
  static dnnl::memory Map(const MapShape& shape) {
    return MakeMemory(dnnl::memory::desc({kStacks, shape.channels, shape.height, shape.width},
                                         ComputeType(GetParam()), dnnl::memory::format_tag::nchw));
  }

  void Make(int height, int width) {
    plan_ = NetworkPlan({kPlanes, height, width});
    plan_.Add(NetworkPlan::SpatialSoftmax{.name = "points", .key = "k", .sharpness = kSharpness});
    source_ = Map(plan_.input());
    gradient_ = Map(plan_.input());
    layer_ = std::make_unique<SpatialSoftmax>(Context(none_, kStacks), plan_.layers()[0], source_,
                                              gradient_);
  }

  Values Forward(const Values& x) {
    FillMemory(x, source_);
    layer_->Forward(Statistics::kBatch);
    return ToDoubles(ReadMemory(layer_->output()));
  }

  void Compare(int height, int width) {
    Make(height, width);
    const reference::PointsShape shape{kStacks * kPlanes, height, width, kSharpness};
    Values x = RandomValues(size_t(shape.planes * height * width), 1);
    EXPECT_EQ(plan_.output(), (MapShape{kPlanes, 1, 2}));
    Forward(x);
    EXPECT_LT(RelativeError(ReadMemory(layer_->output()), reference::Points(shape, x)),
              Tolerance(GetParam()));

    const Values dy = RandomValues(size_t(shape.planes) * 2, 2);
    FillMemory(dy, layer_->output_gradient());
    layer_->Backward();
    Values exact(x.size());
    for (size_t i = 0; i < x.size(); ++i) {
      exact[i] = CentralDifference(&x[i], [&] { return Dot(dy, reference::Points(shape, x)); });
    }
    EXPECT_LT(RelativeError(ReadMemory(gradient_), exact), Tolerance(GetParam()));
  }

  ParameterSet none_{{}, ParameterSet::Use::kTraining};
  NetworkPlan plan_;
  dnnl::memory source_, gradient_;
  std::unique_ptr<SpatialSoftmax> layer_;
};

TEST_P(SpatialSoftmaxTest, PointsAndTheirGradientsAgreeWithTheReference) {
  Compare(6, 9);
  Compare(18, 18);
  Compare(1, 4);
  Compare(3, 1);
}

TEST_P(SpatialSoftmaxTest, ALonePeakIsWhereItIsAndAFlatMapIsItsMiddle) {
  Make(3, 5);
  Values x(size_t{kStacks} * kPlanes * 15);
  x[4] = 1000;               // the first map's upper right corner
  x[15 + 10] = 1000;         // the second one's lower left
  x[2 * 15 + 2] = -100'000;  // leaves the others equal: below the middle
  const Values points = Forward(x);
  EXPECT_EQ((Values{points.begin(), points.begin() + 4}), (Values{1, -1, -1, 1}));
  EXPECT_NEAR(points[4], 0, 1e-6);
  EXPECT_NEAR(points[5], 1. / 14, 1e-3);
  EXPECT_NEAR(points[6], 0, 1e-6);
  EXPECT_NEAR(points[7], 0, 1e-6);
}

INSTANTIATE_PRECISIONS(SpatialSoftmaxTest);

}  // namespace
}  // namespace shoal::nn
