// SPDX-License-Identifier: Apache-2.0
#include "launch/tools/film/film_strip.h"

#include <gtest/gtest.h>

#include "common/base/files.h"
#include "tests/common/image/png_file.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

// Pictures of 4 x 2 pixels, the i-th all of red i, green 100, blue 200.
StripImage StripOf(int pictures) {
  FilmStrip strip;
  for (int i = 0; i < pictures; ++i) {
    std::vector<uint8_t> pixels;
    for (int p = 0; p < 8; ++p) {
      pixels.insert(pixels.end(), {200, 100, static_cast<uint8_t>(i), 77});
    }
    strip.Add({4, 2, 16, pixels});
  }
  return strip.Image();
}

// Red of each picture in the strip.
std::vector<int> RedsOf(const StripImage& strip) {
  const TemporaryFolder folder;
  WriteFileAtomically(folder.path() / "strip.png", strip.png);
  const PngPicture png = ReadRgbPng((folder.path() / "strip.png").string());
  EXPECT_EQ(png.width, strip.width);
  EXPECT_EQ(png.height, 1) << "every second row";
  std::vector<int> reds;
  for (int x = 0; x < png.width; x += 2) {  // every second column of four
    const auto at = static_cast<size_t>(3 * x);
    reds.push_back(png.pixels[at]);
    EXPECT_EQ(png.pixels[at + 1], 100);
    EXPECT_EQ(png.pixels[at + 2], 200);
    EXPECT_EQ(png.pixels[at + 3], png.pixels[at]);
  }
  return reds;
}

TEST(FilmStrip, ShowsAllOfFewPictures) {
  EXPECT_EQ(RedsOf(StripOf(1)), (std::vector{0}));
  EXPECT_EQ(RedsOf(StripOf(4)), (std::vector{0, 1, 2, 3}));
}

TEST(FilmStrip, SpreadsManyFromTheFirstToTheLast) {
  for (const int pictures : {7, 11, 12, 13, 50, 201}) {
    const std::vector<int> reds = RedsOf(StripOf(pictures));
    ASSERT_EQ(reds.size(), FilmStrip::kPictures) << pictures;
    EXPECT_EQ(reds.front(), 0);
    EXPECT_EQ(reds.back(), pictures - 1);
    for (size_t i = 1; i < reds.size(); ++i) {
      EXPECT_GT(reds[i], reds[i - 1]) << pictures;
      EXPECT_LE(reds[i] - reds[i - 1], 2 * (pictures - 1) / 5 + 1) << pictures;
    }
  }
}

}  // namespace
}  // namespace shoal::launch
