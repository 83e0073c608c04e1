// SPDX-License-Identifier: Apache-2.0
#include "replay_server/core/random_shift.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>

#include "common/base/check.h"
#include "common/base/cpu_clones.h"

namespace shoal::replay {
namespace {

constexpr int kWord = 8;  // bytes of a border that are written at once
static_assert(std::endian::native == std::endian::little, "a word's first byte is its lowest");

uint64_t LoadWord(const uint8_t* from) {
  uint64_t word;
  std::memcpy(&word, from, kWord);
  return word;
}

// `pixel` in every byte.
uint64_t Spread(uint8_t pixel) { return pixel * uint64_t{0x0101010101010101}; }

// The first kWord pixels of a row that was moved to the right by `left` pixels, 0 < left < kWord.
uint64_t LeftEnd(const uint8_t* row, int left) {
  const uint64_t border = Spread(row[0]) & (~uint64_t{0} >> (8 * (kWord - left)));
  return LoadWord(row) << (8 * left) | border;
}

// The last kWord pixels of a row of `width` that was moved to the left by `right` pixels.
uint64_t RightEnd(const uint8_t* row, int width, int right) {
  const uint64_t border = Spread(row[width - 1]) & (~uint64_t{0} << (8 * (kWord - right)));
  return LoadWord(row + width - kWord) >> (8 * right) | border;
}

// Fills the columns of `rows` rows to which no column of `in` was moved.
void FillColumns(const uint8_t* in, int rows, int width, int dx, uint8_t* __restrict out) {
  const int left = std::max(0, -dx), right = std::max(0, dx);
  const bool in_words = std::abs(dx) < kWord && width >= kWord;
  for (int i = 0; i < rows; ++i, in += width, out += width) {
    if (!in_words) {
      std::memset(out, in[0], size_t(left));
      std::memset(out + width - right, in[width - 1], size_t(right));
    } else if (left > 0) {
      const uint64_t word = LeftEnd(in, left);
      std::memcpy(out, &word, kWord);
    } else {
      const uint64_t word = RightEnd(in, width, right);
      std::memcpy(out + width - kWord, &word, kWord);
    }
  }
}

// Fills the border of one plane, to which no pixel of `in` was moved: columns, then whole rows.
void FillBorder(const uint8_t* in, int height, int width, Shift shift, uint8_t* __restrict out) {
  const int top = std::max(0, -shift.dy), bottom = std::max(0, shift.dy);
  const int rows = height - top - bottom;
  uint8_t* const moved = out + top * width;
  if (shift.dx != 0) FillColumns(in + bottom * width, rows, width, shift.dx, moved);
  for (int i = 0; i < top; ++i) std::memcpy(out + i * width, moved, size_t(width));
  for (int i = 0; i < bottom; ++i) {
    uint8_t* const row = moved + (rows + i) * width;
    std::memcpy(row, row - width, size_t(width));
  }
}

// Copies `bytes` bytes in blocks of vectors. For frames, std::memcpy uses `rep movsb` on Intel
// CPUs. This is slower if the two addresses are not aligned alike: on a Xeon with AVX-512, a batch
// needed 1.09 times the CPU time (median of 8 pairs of shoal-bench-batches --drawn --threads 1).
SHOAL_CPU_CLONES void CopyBlocks(const uint8_t* in, size_t bytes, uint8_t* __restrict out) {
  using Block = uint64_t __attribute__((vector_size(64)));
  size_t at = 0;
  for (; at + sizeof(Block) <= bytes; at += sizeof(Block)) {
    Block block;
    std::memcpy(&block, in + at, sizeof(Block));
    std::memcpy(out + at, &block, sizeof(Block));
  }
  std::memcpy(out + at, in + at, bytes - at);
}

}  // namespace

Shift DrawShift(int pad, Random* random) {
  const uint64_t choices = 2 * uint64_t(pad) + 1;
  const int dx = int(random->Below(choices)) - pad;
  const int dy = int(random->Below(choices)) - pad;
  return {dx, dy};
}

void ShiftPlanes(const uint8_t* in, int planes, int height, int width, Shift shift, uint8_t* out) {
  CHECK(planes > 0 && height > 0 && width > 0) << planes << "x" << height << "x" << width;
  CHECK(std::abs(shift.dx) < width && std::abs(shift.dy) < height)
      << "shift " << shift.dx << "," << shift.dy << " of " << height << "x" << width;
  // In and out are equally wide, so every pixel moves equally far in memory and one block is
  // copied. The borders then overwrite what came from neighbouring rows and planes.
  const int bytes = planes * height * width, distance = shift.dy * width + shift.dx;
  CopyBlocks(in + std::max(0, distance), size_t(bytes - std::abs(distance)),
             out + std::max(0, -distance));
  for (int p = 0; p < planes; ++p, in += height * width, out += height * width) {
    FillBorder(in, height, width, shift, out);
  }
}

}  // namespace shoal::replay
