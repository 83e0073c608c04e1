// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/random_shift.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "common/base/files.h"
#include "common/nn/safetensors.h"
#include "tests/support/paths.h"
#include "tests/support/shared_numbers.h"

namespace shoal::replay {
namespace {

std::vector<uint8_t> ImageNoise(size_t size, uint64_t seed) {
  Random random(seed);
  std::vector<uint8_t> pixels(size);
  for (uint8_t& pixel : pixels) pixel = static_cast<uint8_t>(random.Next());
  return pixels;
}

// The definition: pad by replication into a larger image, then crop.
std::vector<uint8_t> PadAndCrop(const std::vector<uint8_t>& in, int planes, int height, int width,
                                int pad, Shift shift) {
  const int padded_height = height + 2 * pad, padded_width = width + 2 * pad;
  std::vector<uint8_t> padded(static_cast<size_t>(planes) * padded_height * padded_width);
  for (int p = 0; p < planes; ++p) {
    for (int i = 0; i < padded_height; ++i) {
      for (int j = 0; j < padded_width; ++j) {
        const int y = std::min(std::max(i - pad, 0), height - 1);
        const int x = std::min(std::max(j - pad, 0), width - 1);
        padded[(p * padded_height + i) * padded_width + j] = in[(p * height + y) * width + x];
      }
    }
  }
  std::vector<uint8_t> out(in.size());
  for (int p = 0; p < planes; ++p) {
    for (int i = 0; i < height; ++i) {
      for (int j = 0; j < width; ++j) {
        out[(p * height + i) * width + j] =
            padded[(p * padded_height + i + pad + shift.dy) * padded_width + j + pad + shift.dx];
      }
    }
  }
  return out;
}

TEST(RandomShift, IsPaddingByReplicationAndACropAtEveryOffset) {
  struct Size {
    int planes, height, width, pad;
  };
  for (const Size& s :
       {Size{1, 1, 1, 0}, Size{2, 5, 7, 4}, Size{3, 9, 5, 4}, Size{1, 84, 84, 4},
        Size{6, 17, 33, 2}, Size{2, 3, 64, 2}, Size{2, 20, 30, 9}, Size{2, 9, 8, 7}}) {
    const auto in = ImageNoise(static_cast<size_t>(s.planes) * s.height * s.width, 3);
    for (int dy = -s.pad; dy <= s.pad; ++dy) {
      for (int dx = -s.pad; dx <= s.pad; ++dx) {
        // A guard byte on either side: nothing is written outside.
        std::vector<uint8_t> out(in.size() + 2, 0xab);
        ShiftPlanes(in.data(), s.planes, s.height, s.width, {dx, dy}, out.data() + 1);
        ASSERT_EQ(out.front(), 0xab);
        ASSERT_EQ(out.back(), 0xab);
        ASSERT_EQ(std::vector<uint8_t>(out.begin() + 1, out.end() - 1),
                  PadAndCrop(in, s.planes, s.height, s.width, s.pad, {dx, dy}))
            << s.height << "x" << s.width << " shift " << dx << "," << dy;
      }
    }
  }
}

TEST(RandomShift, ByHand) {
  const std::vector<uint8_t> in = {1, 2, 3,  //
                                   4, 5, 6};
  std::vector<uint8_t> out(6);
  ShiftPlanes(in.data(), 1, 2, 3, {.dx = 1, .dy = 0}, out.data());
  EXPECT_EQ(out, (std::vector<uint8_t>{2, 3, 3, 5, 6, 6}));
  ShiftPlanes(in.data(), 1, 2, 3, {.dx = -2, .dy = 1}, out.data());
  EXPECT_EQ(out, (std::vector<uint8_t>{4, 4, 4, 4, 4, 4}));
}

// The paper's program samples a grid by bilinear interpolation. Its points are centres of pixels,
// so that the result is the crop, except for rounding of the points' positions in f32.
TEST(RandomShift, IsTheGridSampleOfDrqV2) {
  constexpr int kPad = 4, kPlanes = 2, kSide = 12;
  constexpr size_t kPicture = size_t{kPlanes} * kSide * kSide;
  // Recorded by tests/comparison/drqv2_updates.py, which describes the file.
  const nn::TensorMap recorded =
      nn::ReadSafetensors(ReadFile(GoldenPath("drqv2/shifts.safetensors")), "shifts");
  const nn::NamedTensor& tensor = recorded.at("shifted");
  std::vector<uint8_t> pictures((2 * kPad + 1) * kPicture), shifted(kPicture);
  FillBytes("shift.pixels", pictures);
  ASSERT_EQ(tensor.data.size(), pictures.size() * sizeof(float));
  std::vector<float> expected(pictures.size());
  std::memcpy(expected.data(), tensor.data.data(), tensor.data.size());
  for (int k = 0; k <= 2 * kPad; ++k) {
    const size_t first = static_cast<size_t>(k) * kPicture;
    ShiftPlanes(pictures.data() + first, kPlanes, kSide, kSide, {.dx = k - kPad, .dy = kPad - k},
                shifted.data());
    for (size_t i = 0; i < kPicture; ++i) {
      ASSERT_NEAR(shifted[i], expected[first + i], 1e-3) << k << " " << i;
    }
  }
}

TEST(RandomShift, DrawsEveryOffsetEquallyOften) {
  constexpr int kPad = 2, kDraws = 100'000, kCells = 25;
  std::vector<int> counts(kCells);
  Random random(8);
  for (int i = 0; i < kDraws; ++i) {
    const Shift shift = DrawShift(kPad, &random);
    ASSERT_LE(std::abs(shift.dx), kPad);
    ASSERT_LE(std::abs(shift.dy), kPad);
    ++counts[static_cast<size_t>(shift.dy + kPad) * 5 + (shift.dx + kPad)];
  }
  const double p = 1.0 / kCells, sigma = std::sqrt(kDraws * p * (1 - p));
  for (const int count : counts) EXPECT_NEAR(count, kDraws * p, 5 * sigma);
}

TEST(RandomShift, UsesAsManyDrawsWhateverThePad) {
  Random with(1), without(1);
  DrawShift(4, &with);
  EXPECT_EQ(DrawShift(0, &without), Shift{});
  EXPECT_EQ(with.state(), without.state());
}

TEST(RandomShiftDeathTest, ChecksThatSomeOfTheImageIsLeft) {
  std::vector<uint8_t> in(6), out(6);
  EXPECT_DEATH(ShiftPlanes(in.data(), 1, 2, 3, {.dx = 3, .dy = 0}, out.data()), "shift 3,0");
}

}  // namespace
}  // namespace shoal::replay
