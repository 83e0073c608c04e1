// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/texture_levels.h"

#include <gtest/gtest.h>

#include <vector>

namespace shoal::worlds::native {
namespace {

std::vector<uint8_t> Filled(size_t texels, uint8_t r, uint8_t g, uint8_t b) {
  std::vector<uint8_t> rgb;
  for (size_t i = 0; i < texels; ++i) rgb.insert(rgb.end(), {r, g, b});
  return rgb;
}

// The texel of a level, past the frame of one texel around each face. A texel in the middle is the
// upper one of a pair and the lower one of another.
int32_t At(const Texture& texture, int level, int face, int y, int x) {
  const int stride = texture.width[level] + 2, height = texture.height[level];
  const TexelPair* at = texture.level[level] + (face * (height + 1) + y + 1) * stride + x + 1;
  if (y < 0) return at->upper;
  const int32_t texel = (at - stride)->lower;
  if (y < height) {
    EXPECT_EQ(at->upper, texel) << "face " << face << ", " << y << ", " << x;
  }
  return texel;
}

TEST(TextureLevels, HalveUntilOneTexelIsLeft) {
  const TextureLevels levels(Filled(300 * 75, 1, 2, 3), 300, 75, /*cube=*/false);
  const Texture& view = levels.view();
  const int widths[] = {300, 150, 75, 37, 18, 9, 4, 2, 1};
  const int heights[] = {75, 37, 18, 9, 4, 2, 1, 1, 1};
  ASSERT_EQ(view.levels, 9);
  for (int i = 0; i < 9; ++i) {
    EXPECT_EQ(view.width[i], widths[i]);
    EXPECT_EQ(view.height[i], heights[i]);
    EXPECT_EQ(At(view, i, 0, 0, 0), 1 | 2 << 8 | 3 << 16) << "level " << i;
  }
}

TEST(TextureLevels, TexelsOfALevelAreTheMeanOfFourBelow) {
  std::vector<uint8_t> rgb = Filled(4, 0, 0, 0);
  rgb[0] = 100;
  rgb[3] = 60;
  rgb[6] = 20;
  rgb[9] = 21;
  const TextureLevels levels(rgb, 2, 2, /*cube=*/false);
  EXPECT_EQ(At(levels.view(), 1, 0, 0, 0), 50);  // 201 / 4, rounded
}

TEST(TextureLevels, ASquareCubeRepeatsItsFace) {
  const TextureLevels levels(Filled(4, 9, 0, 0), 2, 2, /*cube=*/true);
  const Texture& view = levels.view();
  EXPECT_TRUE(view.cube);
  for (int face = 0; face < 6; ++face) {
    EXPECT_EQ(At(view, 0, face, 1, 1), 9);
    EXPECT_EQ(At(view, 1, face, 0, 0), 9);
  }
}

TEST(TextureLevels, ACubeOfSixFacesKeepsEach) {
  std::vector<uint8_t> rgb;
  for (uint8_t face = 0; face < 6; ++face) {
    const std::vector<uint8_t> one = Filled(4, face, 0, 0);
    rgb.insert(rgb.end(), one.begin(), one.end());
  }
  const TextureLevels levels(rgb, 2, 12, /*cube=*/true);
  for (int face = 0; face < 6; ++face) {
    EXPECT_EQ(At(levels.view(), 0, face, 1, 0), face);
    EXPECT_EQ(At(levels.view(), 1, face, 0, 0), face);
  }
}

TEST(TextureLevels, FramesRepeatTheTextureOrTheCubesEdge) {
  std::vector<uint8_t> rgb;
  for (uint8_t texel = 0; texel < 4; ++texel) rgb.insert(rgb.end(), {texel, 0, 0});
  const TextureLevels flat(rgb, 2, 2, /*cube=*/false), cube(rgb, 2, 2, /*cube=*/true);
  EXPECT_EQ(At(flat.view(), 0, 0, 0, -1), 1);
  EXPECT_EQ(At(flat.view(), 0, 0, -1, 0), 2);
  EXPECT_EQ(At(flat.view(), 0, 0, 2, 2), 0);
  EXPECT_EQ(At(cube.view(), 0, 3, 0, -1), 0);
  EXPECT_EQ(At(cube.view(), 0, 3, -1, 0), 0);
  EXPECT_EQ(At(cube.view(), 0, 3, 2, 2), 3);
  for (int y = -1; y <= 2; ++y) {
    for (int x = -1; x <= 2; ++x) {
      EXPECT_EQ(At(flat.view(), 0, 0, y, x), (y & 1) * 2 + (x & 1));
      EXPECT_EQ(At(cube.view(), 0, 5, y, x), (y > 0) * 2 + (x > 0));
    }
  }
}

}  // namespace
}  // namespace shoal::worlds::native
