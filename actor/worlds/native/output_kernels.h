// SPDX-License-Identifier: Apache-2.0
// Finished colours as planes of bytes. Included by the sources of the kernels.
#pragma once

#include "actor/worlds/native/frame_job.h"
#include "actor/worlds/native/lanes.h"

namespace {

using namespace shoal::worlds::native;

constexpr int kColumns = 16;  // that are written at once

// Four pixels of a row of a tile. Columns 0 and 1 are adjacent; columns 2 and 3 follow 4 numbers
// later.
SHOAL_INLINE __m128i FourPixels(const int32_t* row) {
  return _mm_unpacklo_epi64(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(row)),
                            _mm_loadl_epi64(reinterpret_cast<const __m128i*>(row + 4)));
}

// The bytes of two vectors, alternating.
struct Interleaved {
  __m128i low, high;
};

SHOAL_INLINE Interleaved Interleave(__m128i a, __m128i b) {
  return {_mm_unpacklo_epi8(a, b), _mm_unpackhi_epi8(a, b)};
}

SHOAL_INLINE void WriteBytes(uint8_t* to, __m128i bytes) {
  _mm_storeu_si128(reinterpret_cast<__m128i*>(to), bytes);
}

// Writes 16 pixels of one row, from four tiles, by a transposition of 16 x 4 bytes.
SHOAL_INLINE void WriteSixteen(const int32_t* row, uint8_t* to, int64_t plane) {
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
  WriteBytes(to, red_green.low);
  WriteBytes(to + plane, red_green.high);
  WriteBytes(to + 2 * plane, Interleave(even.high, odd.high).low);
}

// Writes up to 4 pixels of one row of a tile.
SHOAL_INLINE void WriteFew(const int32_t* row, int count, uint8_t* to, int64_t plane) {
  const int32_t pixels[4] = {row[0], row[1], row[4], row[5]};
  for (int channel = 0; channel < 3; ++channel) {
    for (int x = 0; x < count; ++x) {
      to[channel * plane + x] = static_cast<uint8_t>(pixels[x] >> (8 * channel) & 255);
    }
  }
}

// The first of the last columns that are written at once, so that they reach the end of a row. Some
// columns are then written twice. -1 = the row has too few columns or ends within a tile.
SHOAL_INLINE int LastSixteen(int width) {
  return width >= kColumns && width % kTileSide == 0 ? width - kColumns : -1;
}

#if SHOAL_LANES == 16
// An order of 16 bytes, which are 2x2 pixels: the reds of the upper two and of the lower two
// pixels, then greens, blues and zeros.
alignas(16) constexpr int8_t kByChannel[16] = {0, 4, 8,  12, 1,  5,  9,  13,
                                               2, 6, 10, 14, -1, -1, -1, -1};
// From two tiles in that order, pairs of bytes: rows 0 to 3 of reds, then of greens.
alignas(64) constexpr int16_t kRedGreen[32] = {0,  8,  32, 40, 1,  9,  33, 41, 16, 24, 48,
                                               56, 17, 25, 49, 57, 2,  10, 34, 42, 3,  11,
                                               35, 43, 18, 26, 50, 58, 19, 27, 51, 59};
// The blues, twice.
alignas(64) constexpr int16_t kBlue[32] = {4,  12, 36, 44, 5,  13, 37, 45, 20, 28, 52,
                                           60, 21, 29, 53, 61, 4,  12, 36, 44, 5,  13,
                                           37, 45, 20, 28, 52, 60, 21, 29, 53, 61};

// Writes the rows of one channel: two of each part of 16 bytes.
template <int kPart>
SHOAL_INLINE void WriteTwoRows(uint8_t* to, int64_t width, __m512i even, __m512i odd) {
  WriteBytes(to, _mm512_extracti32x4_epi32(even, kPart));
  WriteBytes(to + width, _mm512_extracti32x4_epi32(odd, kPart));
}

// Four whole tiles beside each other.
SHOAL_INLINE void WriteFourTiles(const int32_t* tiles, uint8_t* to, int64_t width, int64_t plane) {
  const __m512i order =
      _mm512_broadcast_i32x4(_mm_load_si128(reinterpret_cast<const __m128i*>(kByChannel)));
  const auto tile = [&](int i) {
    return _mm512_shuffle_epi8(_mm512_loadu_si512(tiles + i * kTilePixels), order);
  };
  const __m512i a = tile(0), b = tile(1), c = tile(2), d = tile(3);
  const __m512i red_green = _mm512_load_si512(kRedGreen), blue = _mm512_load_si512(kBlue);
  const __m512i first = _mm512_permutex2var_epi16(a, red_green, b);
  const __m512i second = _mm512_permutex2var_epi16(c, red_green, d);
  const __m512i even = _mm512_unpacklo_epi64(first, second);
  const __m512i odd = _mm512_unpackhi_epi64(first, second);
  WriteTwoRows<0>(to, width, even, odd);
  WriteTwoRows<1>(to + 2 * width, width, even, odd);
  to += plane;
  WriteTwoRows<2>(to, width, even, odd);
  WriteTwoRows<3>(to + 2 * width, width, even, odd);
  to += plane;
  const __m512i first_blue = _mm512_permutex2var_epi16(a, blue, b);
  const __m512i second_blue = _mm512_permutex2var_epi16(c, blue, d);
  const __m512i even_blue = _mm512_unpacklo_epi64(first_blue, second_blue);
  const __m512i odd_blue = _mm512_unpackhi_epi64(first_blue, second_blue);
  WriteTwoRows<0>(to, width, even_blue, odd_blue);
  WriteTwoRows<1>(to + 2 * width, width, even_blue, odd_blue);
}

// Writes the first columns of four whole rows. Returns how many are written.
SHOAL_INLINE int WriteRowsOfTiles(const int32_t* tiles, int width, uint8_t* to, int64_t plane) {
  int x = 0;
  for (; x + kColumns <= width; x += kColumns) {
    WriteFourTiles(tiles + x * kTileSide, to + x, width, plane);
  }
  const int last = LastSixteen(width);
  if (last < 0 || x == width) return x;
  WriteFourTiles(tiles + last * kTileSide, to + last, width, plane);
  return width;
}
#else
SHOAL_INLINE int WriteRowsOfTiles(const int32_t*, int, uint8_t*, int64_t) { return 0; }
#endif

void Write(const View& view, const int32_t* colours, uint8_t* planes) {
  const int width = view.width, last = LastSixteen(width);
  const int64_t plane = int64_t{width} * view.height;
  for (int top = 0; top < view.height; top += kTileSide) {
    const int32_t* tiles = colours + int64_t{top / kTileSide} * view.tiles_x * kTilePixels;
    uint8_t* to = planes + int64_t{top} * width;
    const int rows = view.height - top < kTileSide ? view.height - top : kTileSide;
    const int written = rows == kTileSide ? WriteRowsOfTiles(tiles, width, to, plane) : 0;
    if (written == width) continue;
    for (int y = 0; y < rows; ++y, to += width) {
      const int32_t* row = tiles + 2 * (y & 1) + 8 * (y >> 1);
      int x = written;
      for (; x + kColumns <= width; x += kColumns) {
        WriteSixteen(row + x * kTileSide, to + x, plane);
      }
      if (x == width) continue;
      if (last >= 0) {
        WriteSixteen(row + last * kTileSide, to + last, plane);
        continue;
      }
      for (; x < width; x += kTileSide) {
        const int count = width - x < kTileSide ? width - x : kTileSide;
        WriteFew(row + x * kTileSide, count, to + x, plane);
      }
    }
  }
}

}  // namespace
