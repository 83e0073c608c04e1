// SPDX-License-Identifier: Apache-2.0
#include "common/base/random_bytes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace shoal {
namespace {

TEST(RandomBytes, FillTheWholeSpanAndNeverRepeat) {
  std::array<std::byte, 256> once{}, again{};
  FillWithRandomBytes(once);
  FillWithRandomBytes(again);
  EXPECT_NE(once, again);
  const std::span half = std::span(once).last(128);
  EXPECT_FALSE(std::ranges::all_of(half, [](std::byte byte) { return byte == std::byte{0}; }));
}

TEST(RandomBytesDeath, MoreThanTheKernelGivesAtOnceIsABug) {
  std::array<std::byte, 257> bytes{};
  EXPECT_DEATH(FillWithRandomBytes(bytes), "257");
}

}  // namespace
}  // namespace shoal
