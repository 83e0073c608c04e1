// SPDX-License-Identifier: Apache-2.0
#include "common/image/text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace shoal::image {
namespace {

constexpr int kWidth = 20, kHeight = 9;

// The image as rows of '#' and '.'.
std::vector<std::string> Drawn(std::string_view text, int x = 0, int y = 0) {
  std::vector<uint8_t> rgb(kWidth * kHeight * 3, 255);
  DrawText(text, x, y, {10, 20, 30}, kWidth, kHeight, rgb);
  std::vector<std::string> rows(kHeight, std::string(kWidth, '.'));
  for (size_t pixel = 0; pixel < rgb.size() / 3; ++pixel) {
    if (rgb[3 * pixel] == 255) continue;
    EXPECT_EQ(rgb[3 * pixel], 10);
    EXPECT_EQ(rgb[3 * pixel + 1], 20);
    EXPECT_EQ(rgb[3 * pixel + 2], 30);
    rows[pixel / kWidth][pixel % kWidth] = '#';
  }
  return rows;
}

TEST(Text, LettersLookLikeThemselvesFromLeftToRight) {
  const std::vector<std::string> expected = {
      "#......###...........", "#.......#............", "#.......#............",
      "#.......#............", "#.......#............", "#.......#............",
      "#####..###...........",
  };
  const std::vector<std::string> rows = Drawn("LI");
  for (size_t row = 0; row < 7; ++row) EXPECT_EQ(rows[row], expected[row].substr(0, kWidth)) << row;
  EXPECT_EQ(rows[7], std::string(kWidth, '.')) << "lines do not touch";
}

TEST(Text, EveryPrintableCharacterHasAGlyphOfItsOwn) {
  std::set<std::vector<std::string>> seen;
  for (char c = ' '; c <= '~'; ++c) {
    EXPECT_TRUE(seen.insert(Drawn(std::string(1, c))).second) << c;
  }
  EXPECT_EQ(seen.size(), 95u);
}

TEST(Text, WhatLiesOutsideIsLeftOut) {
  const auto ink = [](const std::vector<std::string>& rows) {
    std::ptrdiff_t count = 0;
    for (const std::string& row : rows) count += std::count(row.begin(), row.end(), '#');
    return count;
  };
  EXPECT_EQ(ink(Drawn("L", -100, 0)), 0);
  EXPECT_EQ(ink(Drawn("L", 0, 100)), 0);
  EXPECT_EQ(ink(Drawn("L", -1, 0)), 4) << "the foot without its first pixel";
  EXPECT_EQ(ink(Drawn("L", kWidth - 2, 0)), 8) << "the stem and one pixel of the foot";
  EXPECT_EQ(ink(Drawn("L", 0, -3)), 8) << "the four lowest rows";
}

TEST(Text, OtherCharactersShowAQuestionMark) { EXPECT_EQ(Drawn("\t"), Drawn("?")); }

}  // namespace
}  // namespace shoal::image
