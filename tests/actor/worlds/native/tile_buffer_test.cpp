// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/tile_buffer.h"

#include <gtest/gtest.h>

#include <array>
#include <span>
#include <vector>

#include "actor/worlds/native/renderer.h"

namespace shoal::worlds::native {
namespace {

std::vector<const Kernels*> SupportedKernels() {
  std::vector<const Kernels*> kernels{&kSse2Kernels};
  if (Supported(InstructionSet::kAvx2)) kernels.push_back(&kAvx2Kernels);
  if (Supported(InstructionSet::kAvx512)) kernels.push_back(&kAvx512Kernels);
  return kernels;
}

// Each pixel's colour says its column and row, through the tables of rays that the kernels use.
TEST(TileBuffer, PlanesAreInTheOrderOfRowsWhateverTheSize) {
  for (const auto& [width, height] :
       {std::array{8, 4}, std::array{5, 7}, std::array{1, 1}, std::array{16, 4}, std::array{39, 6},
        std::array{20, 5}, std::array{84, 84}, std::array{83, 82}, std::array{64, 11}}) {
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
    std::vector<int> rows(pixels);
    WriteRows(
        view, [&](size_t at) { return buffer.tiles().colour[at] & 0xffff; }, std::span<int>(rows));
    for (const Kernels* kernels : SupportedKernels()) {
      // A byte more than the planes have must stay as it is.
      std::vector<uint8_t> planes(3 * pixels + 1, 111);
      WritePlanes(*kernels, view, buffer.tiles().colour, std::span(planes).first(3 * pixels));
      ASSERT_EQ(planes.back(), 111);
      for (size_t i = 0; i < pixels; ++i) {
        const int column = static_cast<int>(i) % width, row = static_cast<int>(i) / width;
        ASSERT_EQ(planes[i], column) << kernels->name << ", " << width << " x " << height;
        ASSERT_EQ(planes[pixels + i], row) << kernels->name << ", " << width << " x " << height;
        ASSERT_EQ(planes[2 * pixels + i], 200) << kernels->name << ", " << width << " x " << height;
        ASSERT_EQ(rows[i], column | row << 8);
      }
    }
  }
}

}  // namespace
}  // namespace shoal::worlds::native
