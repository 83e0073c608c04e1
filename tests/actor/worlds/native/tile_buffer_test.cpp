// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/tile_buffer.h"

#include <gtest/gtest.h>

namespace shoal::worlds::native {
namespace {

// Each pixel's colour says its column and row, through the tables of rays that the kernels use.
TEST(TileBuffer, PlanesAreInTheOrderOfRowsWhateverTheSize) {
  for (const auto& [width, height] : {std::array{8, 4}, std::array{5, 7}, std::array{1, 1},
                                      std::array{16, 4}, std::array{39, 6}}) {
    View view{};
    view.width = width;
    view.height = height;
    view.tiles_x = (width + 3) / 4;
    view.tiles_y = (height + 3) / 4;
    TileBuffer buffer;
    buffer.Resize(view);
    for (int tile = 0; tile < view.tiles_x * view.tiles_y; ++tile) {
      for (int i = 0; i < kTilePixels; ++i) {
        const int column = tile % view.tiles_x * 4 + (i & 1) + 2 * (i >> 2 & 1);
        const int row = tile / view.tiles_x * 4 + (i >> 1 & 1) + 2 * (i >> 3);
        buffer.tiles().colour[tile * kTilePixels + i] = column | row << 8 | 200 << 16;
      }
    }
    const auto pixels = static_cast<size_t>(width * height);
    std::vector<uint8_t> planes(3 * pixels);
    WritePlanes(view, buffer.tiles().colour, planes);
    std::vector<int> rows(pixels);
    WriteRows(
        view, [&](size_t at) { return buffer.tiles().colour[at] & 0xffff; }, std::span<int>(rows));
    for (size_t i = 0; i < pixels; ++i) {
      const int column = static_cast<int>(i) % width, row = static_cast<int>(i) / width;
      ASSERT_EQ(planes[i], column);
      ASSERT_EQ(planes[pixels + i], row);
      ASSERT_EQ(planes[2 * pixels + i], 200);
      ASSERT_EQ(rows[i], column | row << 8);
    }
  }
}

}  // namespace
}  // namespace shoal::worlds::native
