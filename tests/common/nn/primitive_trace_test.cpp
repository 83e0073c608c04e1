// SPDX-License-Identifier: Apache-2.0
#include "tests/common/nn/primitive_trace.h"

#include <gtest/gtest.h>

#include <vector>

#include "common/nn/policy.h"

namespace shoal::nn {
namespace {

constexpr int kConvolutions = 2;

// One with pixels whose encoder has two convolutions.
class PrimitiveTraceTest : public testing::Test {
 protected:
  static NetworkConfig Network() {
    NetworkConfig network;
    network.filters.assign(kConvolutions, 4);
    network.strides.assign(kConvolutions, 2);
    network.hidden = {8};
    return network;
  }
  static ObservationSpec Spec() {
    ObservationSpec spec;
    spec.cameras = {"front"};
    spec.channels = 3;
    spec.height = spec.width = 20;
    spec.action_size = 2;
    return spec;
  }

  // The first pass of a network also brings its weights into their layouts.
  PrimitiveTraceTest() { policy_.Forward(1, dark_.data(), nullptr); }

  Policy policy_{Network(), Spec(), Precision::kF32, 1};
  std::vector<uint8_t> dark_ = std::vector<uint8_t>(3 * 20 * 20, 10);
};

TEST_F(PrimitiveTraceTest, HoldsWhatTheWorkRuns) {
  const PrimitiveTrace once([&] { policy_.Forward(1, dark_.data(), nullptr); });
  const PrimitiveTrace twice([&] {
    policy_.Forward(1, dark_.data(), nullptr);
    policy_.Forward(1, dark_.data(), nullptr);
  });
  EXPECT_EQ(once.Count(PrimitiveTrace::Part::kConvolutions), size_t{kConvolutions});
  EXPECT_GT(once.Count(), size_t{kConvolutions});
  EXPECT_EQ(twice.Count(), 2 * once.Count());
}

TEST_F(PrimitiveTraceTest, CountsWhatConvolutionsCompute) {
  const PrimitiveTrace trace([&] { policy_.Forward(1, dark_.data(), nullptr); });
  // 4 filters of 3 x 3 over 3 channels of 10 x 10 (pooled) to maps of 4 x 4, then over 4 channels
  // to a map of 1 x 1.
  EXPECT_EQ(trace.ConvolutionOperations(), 2 * (16 * 4 * 27 + 4 * 36));
}

TEST_F(PrimitiveTraceTest, RunsThemAgainAndNotesNothing) {
  const PrimitiveTrace trace([&] { policy_.Forward(1, dark_.data(), nullptr); });
  const PrimitiveTrace of_a_run([&] { trace.Run(); });
  EXPECT_EQ(of_a_run.Count(), 0u);
}

}  // namespace
}  // namespace shoal::nn
