// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/frame_packing.h"

#include <gtest/gtest.h>

#include <vector>

namespace shoal::worlds {
namespace {

// 2 rows of 3 pixels, bottom row first: pixel (y, x) counted from the top has colours
// (100 y + 10 x + 1, ... + 2, ... + 3).
const std::vector<uint8_t> kPixels{101, 102, 103, 111, 112, 113, 121, 122, 123,
                                   1,   2,   3,   11,  12,  13,  21,  22,  23};

TEST(FramePacking, ColoursBecomePlanesTopRowFirst) {
  std::vector<uint8_t> planes(18);
  PackRgb(kPixels, 2, 3, planes);
  EXPECT_EQ(planes, (std::vector<uint8_t>{1, 11, 21, 101, 111, 121,  //
                                          2, 12, 22, 102, 112, 122,  //
                                          3, 13, 23, 103, 113, 123}));
}

TEST(FramePacking, GreyIsTheLumaOfEachPixel) {
  const std::vector<uint8_t> pixels{255, 0,   0,   0, 255, 0, 0,  0,  255,  //
                                    255, 255, 255, 0, 0,   0, 90, 90, 90};
  std::vector<uint8_t> plane(6);
  PackGrey(pixels, 2, 3, plane);
  EXPECT_EQ(plane, (std::vector<uint8_t>{255, 0, 90, 77, 149, 29}));
}

TEST(FramePacking, GreyOfPlanesIsThatOfPixels) {
  std::vector<uint8_t> planes(18), plane(6), of_planes(6);
  PackRgb(kPixels, 2, 3, planes);
  PackGrey(kPixels, 2, 3, plane);
  GreyOfPlanes(planes, of_planes);
  EXPECT_EQ(of_planes, plane);
}

TEST(FramePacking, WideRowsPackAsNarrowOnesDo) {
  // Long enough for the widest vectors, odd enough for their remainders.
  constexpr int kHeight = 3, kWidth = 331;
  std::vector<uint8_t> pixels(3 * kHeight * kWidth), planes(3 * kHeight * kWidth);
  for (size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<uint8_t>(i * 31 + i / 256);
  PackRgb(pixels, kHeight, kWidth, planes);
  for (size_t c = 0; c < 3; ++c) {
    for (size_t y = 0; y < kHeight; ++y) {
      for (size_t x = 0; x < kWidth; ++x) {
        ASSERT_EQ(planes[(c * kHeight + y) * kWidth + x],
                  pixels[((kHeight - 1 - y) * kWidth + x) * 3 + c]);
      }
    }
  }
}

TEST(FramePackingDeathTest, RefusesSizesThatDoNotFit) {
  std::vector<uint8_t> planes(17);
  EXPECT_DEATH(PackRgb(kPixels, 2, 3, planes), "17 bytes");
  EXPECT_DEATH(PackGrey(kPixels, 2, 4, planes), "18 bytes");
}

}  // namespace
}  // namespace shoal::worlds
