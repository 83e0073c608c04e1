// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/tile_buffer.h"

#include <cstring>

#include "common/base/check.h"

namespace shoal::worlds::native {

void TileBuffer::Resize(const View& view) {
  const size_t pixels =
      static_cast<size_t>(view.tiles_x) * static_cast<size_t>(view.tiles_y) * kTilePixels;
  if (w_.size() == pixels) return;
  w_.resize(pixels);
  id_.resize(pixels);
  colour_.resize(pixels);
  triangle_.resize(pixels);
}

void TileBuffer::CopyFrom(const TileBuffer& other) {
  CHECK(w_.size() == other.w_.size());
  std::memcpy(w_.data(), other.w_.data(), w_.size() * sizeof(float));
  std::memcpy(id_.data(), other.id_.data(), id_.size() * sizeof(int32_t));
  std::memcpy(colour_.data(), other.colour_.data(), colour_.size() * sizeof(int32_t));
}

void WritePlanes(const Kernels& kernels, const View& view, const int32_t* colours,
                 std::span<uint8_t> planes) {
  const auto width = static_cast<size_t>(view.width), height = static_cast<size_t>(view.height);
  CHECK(planes.size() == 3 * width * height) << planes.size();
  kernels.write(view, colours, planes.data());
}

}  // namespace shoal::worlds::native
