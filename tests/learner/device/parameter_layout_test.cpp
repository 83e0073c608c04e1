// SPDX-License-Identifier: Apache-2.0
#include "learner/device/parameter_layout.h"

#include <gmock/gmock.h>

#include <numeric>
#include <vector>

namespace shoal::learner::device {
namespace {

using testing::Each;

// Two filters of 3 channels and 2x1 pixels, padded to 4 filters and 4 channels.
TEST(ParameterLayout, PutsChannelsLastAndPadsWithZeros) {
  const nn::ParameterSet set({{"a", {5}}, {"w", {2, 3, 2, 1}}}, nn::ParameterSet::Use::kInference);
  ParameterLayout layout(set);
  layout.Set("w",
             {.outer = 2, .padded_outer = 4, .channels = 3, .padded_channels = 4, .pixels = 2});
  EXPECT_EQ(layout.OffsetOf("a"), 0);
  EXPECT_EQ(layout.OffsetOf("w"), 64);
  EXPECT_EQ(layout.size(), 128);
  std::vector<float> host(size_t(set.size()));
  std::iota(host.begin(), host.end(), 1.f);
  std::vector<float> device(128, -1.f);
  layout.ToDevice(host.data(), /*statistics=*/true, device.data());
  const float* weights = host.data() + set.OffsetOf(size_t{1});
  for (size_t n = 0; n < 4; ++n) {
    for (size_t p = 0; p < 2; ++p) {
      for (size_t c = 0; c < 4; ++c) {
        const float expected = n < 2 && c < 3 ? weights[(n * 3 + c) * 2 + p] : 0.f;
        EXPECT_EQ(device[64 + (n * 2 + p) * 4 + c], expected) << n << p << c;
      }
    }
  }
  EXPECT_THAT(std::vector(device.begin() + 5, device.begin() + 64), Each(0.f));
  std::vector<float> back(host.size(), 0.f);
  layout.ToHost(device.data(), /*statistics=*/true, back.data());
  for (size_t i = 0; i < 5; ++i) EXPECT_EQ(back[i], host[i]);
  for (size_t i = 0; i < 12; ++i) {
    EXPECT_EQ(back[set.OffsetOf(size_t{1}) + i], weights[i]);
  }
}

TEST(ParameterLayout, LeavesStatisticsOutOfTrainedArrays) {
  const nn::ParameterSet set({{"s", {3}, {}, /*statistic=*/true}, {"w", {70}}},
                             nn::ParameterSet::Use::kInference);
  const ParameterLayout layout(set);
  EXPECT_EQ(layout.OffsetOf("w"), 0);
  EXPECT_EQ(layout.trained_size(), 128);
  EXPECT_EQ(layout.size(), 192);
  std::vector<float> host(size_t(set.size()), 2.f), device(192, 7.f);
  layout.ToDevice(host.data(), /*statistics=*/false, device.data());
  EXPECT_EQ(device[69], 2.f);
  EXPECT_THAT(std::vector(device.begin() + 128, device.end()), Each(7.f));
}

}  // namespace
}  // namespace shoal::learner::device
