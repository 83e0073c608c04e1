// SPDX-License-Identifier: Apache-2.0
// Buffer of an unfinished picture: depth, id and colour of each pixel, tile after tile.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "actor/worlds/native/frame_job.h"

namespace shoal::worlds::native {

class TileBuffer {
 public:
  void Resize(const View& view);
  // Copies `other`, which has the same size.
  void CopyFrom(const TileBuffer& other);
  Tiles tiles() { return {w_.data(), id_.data(), colour_.data(), triangle_.data()}; }
  size_t bytes() const { return w_.size() * (sizeof(float) + 3 * sizeof(int32_t)); }
  std::vector<int32_t>& colours() { return colour_; }

 private:
  std::vector<float> w_;
  std::vector<int32_t> id_, colour_, triangle_;
};

// planes (3, H, W), row 0 = top.
void WritePlanes(const Kernels& kernels, const View& view, const int32_t* colours,
                 std::span<uint8_t> planes);

// Values of pixels in the order of rows, (H, W).
template <typename Value, typename Read>
void WriteRows(const View& view, const Read& read, std::span<Value> rows) {
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const int in_tile = (x & 1) + 2 * (y & 1) + 4 * (x >> 1 & 1) + 8 * (y >> 1 & 1);
      const int tile = y / kTileSide * view.tiles_x + x / kTileSide;
      rows[static_cast<size_t>(y) * static_cast<size_t>(view.width) + static_cast<size_t>(x)] =
          read(static_cast<size_t>(tile) * kTilePixels + static_cast<size_t>(in_tile));
    }
  }
}

}  // namespace shoal::worlds::native
