// SPDX-License-Identifier: Apache-2.0
#include "common/nn/bf16.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace shoal::nn {
namespace {

uint16_t Round(float value) {
  uint16_t rounded = 0;
  FloatsToBf16(&value, 1, &rounded);
  return rounded;
}

TEST(Bf16, RoundsToNearestAndTiesToEven) {
  EXPECT_EQ(Round(1.f), 0x3f80);
  EXPECT_EQ(Round(std::bit_cast<float>(0x3f807fffu)), 0x3f80);  // below half-way
  EXPECT_EQ(Round(std::bit_cast<float>(0x3f808000u)), 0x3f80);  // tie, even below
  EXPECT_EQ(Round(std::bit_cast<float>(0x3f818000u)), 0x3f82);  // tie, even above
  EXPECT_EQ(Round(std::bit_cast<float>(0x3f808001u)), 0x3f81);  // above half-way
  EXPECT_EQ(Round(-2.f), 0xc000);
  EXPECT_EQ(Round(-0.f), 0x8000);
}

TEST(Bf16, LargestFloatsRoundToInfinityAndNanStaysNan) {
  EXPECT_EQ(Round(std::numeric_limits<float>::max()), 0x7f80);
  EXPECT_EQ(Round(-std::numeric_limits<float>::infinity()), 0xff80);
  const uint16_t nan = Round(std::bit_cast<float>(0x7f800001u));  // would carry to infinity
  EXPECT_TRUE((nan & 0x7f80) == 0x7f80 && (nan & 0x7f) != 0);
}

TEST(Bf16, WideningIsExactAndRoundingUndoesItForEveryValue) {
  std::vector<uint16_t> all, back(65536);
  for (uint32_t bits = 0; bits < 65536; ++bits) all.push_back(uint16_t(bits));
  std::vector<float> wide(65536);
  Bf16ToFloats(all.data(), 65536, wide.data());
  FloatsToBf16(wide.data(), 65536, back.data());
  for (uint32_t bits = 0; bits < 65536; ++bits) {
    if (std::isnan(wide[bits])) {
      EXPECT_EQ(back[bits], bits | 0x40);  // made quiet
    } else {
      ASSERT_EQ(back[bits], bits);
    }
  }
}

}  // namespace
}  // namespace shoal::nn
