// SPDX-License-Identifier: Apache-2.0
#include "actor/worlds/native/tile_buffer.h"

#include <emmintrin.h>

#include <algorithm>
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

namespace {

// Four pixels of a row of a tile. Columns 0 and 1 are adjacent; columns 2 and 3 follow 4 numbers
// later.
__m128i FourPixels(const int32_t* row) {
  return _mm_unpacklo_epi64(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(row)),
                            _mm_loadl_epi64(reinterpret_cast<const __m128i*>(row + 4)));
}

// The bytes of two vectors, alternating.
struct Interleaved {
  __m128i low, high;
};

Interleaved Interleave(__m128i a, __m128i b) {
  return {_mm_unpacklo_epi8(a, b), _mm_unpackhi_epi8(a, b)};
}

// Writes 16 pixels of one row, from four tiles, by a transposition of 16 x 4 bytes.
void WriteSixteen(const int32_t* row, uint8_t* to, size_t plane) {
  const __m128i a = FourPixels(row), b = FourPixels(row + kTilePixels);
  const __m128i c = FourPixels(row + 2 * kTilePixels), d = FourPixels(row + 3 * kTilePixels);
  // Pixels 0 8, 1 9; 2 10, 3 11; 4 12, 5 13; 6 14, 7 15.
  const Interleaved ac = Interleave(a, c), bd = Interleave(b, d);
  // Pixels 0 4 8 12, 1 5 9 13; 2 6 10 14, 3 7 11 15.
  const Interleaved first = Interleave(ac.low, bd.low), second = Interleave(ac.high, bd.high);
  // Pixels 0 2 4 ..., 1 3 5 ...
  const Interleaved even = Interleave(first.low, second.low);
  const Interleaved odd = Interleave(first.high, second.high);
  const Interleaved red_green = Interleave(even.low, odd.low);
  const __m128i blue = Interleave(even.high, odd.high).low;
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to), red_green.low);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to + plane), red_green.high);
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to + 2 * plane), blue);
}

// Writes up to 4 pixels of one row of a tile.
void WriteFew(const int32_t* row, size_t count, uint8_t* to, size_t plane) {
  const int32_t pixels[4] = {row[0], row[1], row[4], row[5]};
  for (size_t channel = 0; channel < 3; ++channel) {
    for (size_t x = 0; x < count; ++x) {
      to[channel * plane + x] = static_cast<uint8_t>(pixels[x] >> (8 * channel) & 255);
    }
  }
}

}  // namespace

void WritePlanes(const View& view, const int32_t* colours, std::span<uint8_t> planes) {
  const auto width = static_cast<size_t>(view.width), height = static_cast<size_t>(view.height);
  CHECK(planes.size() == 3 * width * height) << planes.size();
  const size_t plane = width * height;
  const size_t in_row = static_cast<size_t>(view.tiles_x) * kTilePixels;
  for (size_t y = 0; y < height; ++y) {
    const int32_t* row = colours + y / kTileSide * in_row + 2 * (y & 1) + 8 * (y >> 1 & 1);
    uint8_t* to = planes.data() + y * width;
    size_t x = 0;
    for (; x + 16 <= width; x += 16) WriteSixteen(row + x * kTileSide, to + x, plane);
    for (; x < width; x += kTileSide) {
      WriteFew(row + x * kTileSide, std::min<size_t>(kTileSide, width - x), to + x, plane);
    }
  }
}

}  // namespace shoal::worlds::native
